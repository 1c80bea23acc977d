//! Writes a small ULog, byte by byte as the format's documentation has it.

/// A log that is being written.
pub struct Log(pub Vec<u8>);

/// The mark of synchronisation.
const SYNC: [u8; 8] = [0x2f, 0x73, 0x13, 0x20, 0x25, 0x0c, 0xbb, 0x12];

impl Log {
    /// With the definitions of `pose` (three floats in an array) and `power`.
    pub fn new() -> Log {
        let mut log = Log(b"ULog\x01\x12\x35\x01\0\0\0\0\0\0\0\0".to_vec());
        log.record(b'B', &[0; 40]);
        log.record(b'F', b"pose:uint64_t timestamp;float[3] p;bool ok;uint8_t[3] _padding0;");
        log.record(b'F', b"power:uint64_t timestamp;double volt;");
        log.record(b'A', b"\0\x03\0pose");
        log.record(b'A', b"\x01\x07\0pose");
        log.record(b'A', b"\0\x09\0power");
        log
    }

    pub fn record(&mut self, kind: u8, payload: &[u8]) {
        self.0.extend((payload.len() as u16).to_le_bytes());
        self.0.push(kind);
        self.0.extend(payload);
    }

    /// A sample of `pose` with p = (k, 2k, 3k).
    pub fn pose(&mut self, id: u16, micros: u64, k: f32) {
        let mut payload = [id.to_le_bytes().as_slice(), &micros.to_le_bytes()].concat();
        [k, 2.0 * k, 3.0 * k].iter().for_each(|v| payload.extend(v.to_le_bytes()));
        payload.push(1);
        self.record(b'D', &payload);
    }

    pub fn power(&mut self, micros: u64, volt: f64) {
        self.record(b'D', &[9u16.to_le_bytes().as_slice(), &micros.to_le_bytes(), &volt.to_le_bytes()].concat());
    }

    pub fn sync(&mut self) {
        self.record(b'S', &SYNC);
    }

    /// `samples` poses at 100 Hz, power at a tenth of it, a mark after each ten.
    pub fn of(samples: u64) -> Log {
        let mut log = Log::new();
        for k in 0..samples {
            log.pose(3, 1_000_000 + 10_000 * k, k as f32);
            log.pose(7, 1_000_500 + 10_000 * k, -(k as f32));
            if k % 10 == 0 {
                log.power(1_000_000 + 10_000 * k, 12.0 + 0.5 * k as f64);
                log.sync();
            }
        }
        log
    }
}
