//! The records of a ULog file, and the position to continue at after damage.
//!
//! A record whose type is none, or that is shorter than its type needs, is damage; what follows is looked for behind the next
//! mark of synchronisation. No more is held than a window of the file.

use std::io::{self, Read};

/// Length of the header of the file.
const HEADER: usize = 16;

/// Length of the header of a record.
const LEAD: usize = 3;

/// Bytes that are read at a time; a record has 65,538 at most.
const WINDOW: usize = 1 << 18;

/// A record that marks a place to go on from.
const SYNC: &[u8] = &[8, 0, b'S', 0x2f, 0x73, 0x13, 0x20, 0x25, 0x0c, 0xbb, 0x12];

/// A larger sum of lengths of arrays in definitions is none of a logger.
const ARRAY_LIMIT: usize = 1 << 20;

/// Largest number of reasons; of more, only the number.
const TOLD: usize = 5;

/// Result of the loop.
pub(super) enum Seen<'a> {
    /// One record with its header.
    Record(&'a [u8]),
    /// Bytes that were passed over.
    Gap(String),
}

/// A file that is read record by record.
pub(super) struct Records<R> {
    source: R,
    window: Vec<u8>,
    /// Start of the unread part of the window.
    start: usize,
    end: usize,
    /// Bytes of the file before the window.
    before: u64,
    ended: bool,
    /// Where sections were appended, increasing.
    appended: Vec<u64>,
    arrays: usize,
    refused: Vec<(String, usize)>,
}

impl<R: Read> Records<R> {
    pub fn new(source: R) -> Self {
        let (window, appended, refused) = (vec![0; WINDOW], Vec::new(), Vec::new());
        Self { source, window, start: 0, end: 0, before: 0, ended: false, appended, arrays: 0, refused }
    }

    /// The first bytes of the file.
    pub fn header(&mut self) -> io::Result<Option<Vec<u8>>> {
        self.fill()?;
        let header = self.window.get(..HEADER.min(self.end)).filter(|header| header.len() == HEADER);
        let header = header.map(<[u8]>::to_vec);
        self.start = HEADER.min(self.end);
        Ok(header)
    }

    /// Where the definitions say that sections were appended to a log that had ended; a record does not go across.
    pub fn append_at(&mut self, offsets: [u64; 3]) {
        if self.appended.is_empty() && offsets != [0; 3] {
            self.appended = offsets.into_iter().filter(|offset| *offset > HEADER as u64).collect();
            self.appended.sort_unstable();
        }
    }

    /// A record that the decoder does not take.
    pub fn refuse(&mut self, why: &str) {
        // the decoder's words may hold a whole definition
        let short = crate::error::short(why.lines().next().unwrap_or_default(), 80);
        match self.refused.iter_mut().find(|(before, _)| *before == short) {
            Some((_, count)) => *count += 1,
            None => self.refused.push((short, 1)),
        }
    }

    /// The records that were not taken, a sentence for each reason.
    pub fn refused(&self) -> Vec<String> {
        let of = |(why, count): &(String, usize)| format!("{count} records are not read: {why}");
        let mut told: Vec<String> = self.refused.iter().take(TOLD).map(of).collect();
        let more: usize = self.refused.iter().skip(TOLD).map(|(_, count)| count).sum();
        told.extend((more > 0).then(|| format!("{more} more records are not read")));
        told
    }

    /// The next record, or what was passed over.
    pub fn next(&mut self) -> io::Result<Option<Seen<'_>>> {
        let left = self.fill()?;
        if left == 0 {
            return Ok(None);
        }
        let at = self.before + self.start as u64;
        let limit =
            self.appended.iter().find(|offset| **offset > at).map_or(usize::MAX, |offset| (offset - at) as usize);
        let size = if left < LEAD { usize::MAX } else { LEAD + self.u16(0) };
        if size > left || size > limit {
            let passed = left.min(limit);
            if passed == left && !self.holds_sync() {
                self.start = self.end;
                return Ok(Some(Seen::Gap(format!("the file ends in a record: its last {left} bytes are not read"))));
            }
            return self.resume(limit).map(Some);
        }
        if !self.is_whole(size) {
            return self.resume(limit).map(Some);
        }
        self.start += size;
        Ok(Some(Seen::Record(&self.window[self.start - size..self.start])))
    }

    /// Goes on behind damage: at the next mark of synchronisation, or where a section was appended.
    fn resume(&mut self, limit: usize) -> io::Result<Seen<'_>> {
        let mut passed = 0;
        loop {
            let left = self.fill()?;
            let rest = &self.window[self.start..self.end];
            let sync = memchr::memmem::find(&rest[1.min(left)..], SYNC).map(|at| at + 1);
            let appended = Some(limit.saturating_sub(passed)).filter(|at| *at <= left && limit != usize::MAX);
            let step = [sync, appended].into_iter().flatten().min();
            let blind = left.saturating_sub(SYNC.len());
            match step {
                Some(step) => {
                    self.start += step;
                    let bytes = passed + step;
                    return Ok(Seen::Gap(format!("{bytes} damaged bytes before byte {} are not read", self.at())));
                }
                None if self.ended || left <= SYNC.len() => {
                    self.start = self.end;
                    let bytes = passed + left;
                    return Ok(Seen::Gap(format!("{bytes} damaged bytes at the end are not read")));
                }
                None => {
                    self.start += blind;
                    passed += blind;
                }
            }
        }
    }

    fn at(&self) -> u64 {
        self.before + self.start as u64
    }

    fn holds_sync(&self) -> bool {
        memchr::memmem::find(&self.window[self.start..self.end], SYNC).is_some()
    }

    fn u16(&self, at: usize) -> usize {
        let at = self.start + at;
        u16::from_le_bytes([self.window[at], self.window[at + 1]]) as usize
    }

    /// Whether a record has a type, and what its type needs.
    fn is_whole(&mut self, size: usize) -> bool {
        let record = &self.window[self.start..self.start + size];
        let payload = &record[LEAD..];
        match record[2] {
            b'A' => payload.len() >= 3,
            b'P' => payload.first().is_some_and(|key| payload.len() > *key as usize),
            b'F' => {
                self.arrays += lengths(payload);
                self.arrays <= ARRAY_LIMIT
            }
            b'Q' => payload.len() >= 2,
            other => other.is_ascii_uppercase(),
        }
    }

    /// Reads on until the window is full or the file ends; how much of it is to come.
    fn fill(&mut self) -> io::Result<usize> {
        if self.end - self.start >= LEAD + usize::from(u16::MAX) || self.ended {
            return Ok(self.end - self.start);
        }
        self.window.copy_within(self.start..self.end, 0);
        self.before += self.start as u64;
        (self.start, self.end) = (0, self.end - self.start);
        while self.end < self.window.len() {
            match self.source.read(&mut self.window[self.end..]) {
                Ok(0) => {
                    self.ended = true;
                    break;
                }
                Ok(count) => self.end += count,
                Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
                Err(error) => return Err(error),
            }
        }
        Ok(self.end)
    }
}

/// Sum of the lengths of the arrays in a definition, `float[3] q`.
fn lengths(definition: &[u8]) -> usize {
    let after = definition.split(|byte| *byte == b'[').skip(1);
    let length = |text: &[u8]| {
        text.iter().take_while(|b| b.is_ascii_digit()).take(9).fold(0, |n, b| 10 * n + (b - b'0') as usize)
    };
    after.map(length).sum()
}
