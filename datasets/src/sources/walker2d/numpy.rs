//! numpy's `.npy` files and its random generator `RandomState`.
//!
//! ```text
//! RandomState    MT19937, Matsumoto and Nishimura (1998), begun with init_genrand
//! uniform        (a·2²⁶ + b) / 2⁵³             a: 27 bits, b: 26 bits of two draws
//! shuffle        for i = n−1 … 1: exchange i with the first draw & mask that is not above i
//! ```
//!
//! `.npy`: magic, version, length of the header, a Python literal that says type, order and shape, then the numbers.

use std::path::Path;

use crate::error::DataError;
use crate::files::regular;

/// Numbers in the state of the generator.
const N: usize = 624;

/// numpy's generator of before 1.17.
pub struct RandomState {
    state: [u32; N],
    next: usize,
}

impl RandomState {
    /// Generator from a seed below 2³².
    pub fn new(seed: u32) -> Self {
        let mut state = [seed; N];
        for i in 1..N {
            let before = state[i - 1];
            state[i] = 1_812_433_253u32.wrapping_mul(before ^ (before >> 30)).wrapping_add(i as u32);
        }
        Self { state, next: N }
    }

    fn draw(&mut self) -> u32 {
        if self.next == N {
            self.turn();
        }
        let mut y = self.state[self.next];
        self.next += 1;
        y ^= y >> 11;
        y ^= (y << 7) & 0x9d2c_5680;
        y ^= (y << 15) & 0xefc6_0000;
        y ^ (y >> 18)
    }

    fn turn(&mut self) {
        for i in 0..N {
            let y = (self.state[i] & 0x8000_0000) | (self.state[(i + 1) % N] & 0x7fff_ffff);
            let odd = if y & 1 == 1 { 0x9908_b0df } else { 0 };
            self.state[i] = self.state[(i + 397) % N] ^ (y >> 1) ^ odd;
        }
        self.next = 0;
    }

    /// Draw from [0, 1).
    pub fn uniform(&mut self) -> f64 {
        let (a, b) = (f64::from(self.draw() >> 5), f64::from(self.draw() >> 6));
        (a * 67_108_864.0 + b) / 9_007_199_254_740_992.0
    }

    /// Exchanges values as numpy does.
    pub fn shuffle<T>(&mut self, values: &mut [T]) {
        for i in (1..values.len()).rev() {
            let mask = u32::MAX >> (i as u32).leading_zeros();
            let j = loop {
                let drawn = (self.draw() & mask) as usize;
                if drawn <= i {
                    break drawn;
                }
            };
            values.swap(i, j);
        }
    }
}

/// An array, row after row.
pub struct State {
    pub rows: usize,
    pub values: Vec<f64>,
}

/// An array of `columns` columns of little-endian floats in C order, in single precision.
pub fn read(path: &Path, columns: usize) -> Result<State, DataError> {
    let bytes = regular::read(path).map_err(|e| DataError::file_system("read", path, &e))?;
    let damaged = |reason: &str| DataError::Damaged { path: path.to_path_buf(), reason: reason.into() };
    let (header, numbers) = parts(&bytes).ok_or_else(|| damaged("it is no array of numpy"))?;
    let wide = header.contains("'<f8'");
    if !(wide || header.contains("'<f4'")) || !header.contains("'fortran_order': False") {
        return Err(damaged("its numbers are not little-endian floats in C order"));
    }
    let size = if wide { 8 } else { 4 };
    let rows = numbers.len() / size / columns;
    if !header.contains(&format!("({rows}, {columns})")) || numbers.len() != rows * columns * size || rows < 2 {
        return Err(damaged(&format!("it has not the shape (steps, {columns})")));
    }
    // As the benchmark's program does, whatever the file has.
    let number = |bytes: &[u8]| match bytes.try_into() {
        Ok(eight) => f64::from(f64::from_le_bytes(eight) as f32),
        Err(_) => f64::from(f32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]])),
    };
    let values: Vec<f64> = numbers.chunks_exact(size).map(number).collect();
    if values.iter().any(|value| !value.is_finite()) {
        return Err(damaged("a state is not finite"));
    }
    Ok(State { rows, values })
}

/// Header and numbers.
fn parts(bytes: &[u8]) -> Option<(&str, &[u8])> {
    let rest = bytes.strip_prefix(b"\x93NUMPY")?;
    let (length, rest) = match rest.first()? {
        1 => (usize::from(u16::from_le_bytes(rest.get(2..4)?.try_into().ok()?)), rest.get(4..)?),
        _ => (u32::from_le_bytes(rest.get(2..6)?.try_into().ok()?) as usize, rest.get(6..)?),
    };
    Some((std::str::from_utf8(rest.get(..length)?).ok()?, rest.get(length..)?))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: the original program's test, and numpy.
    #[test]
    fn draws_are_those_of_numpy() {
        let mut generator = RandomState::new(5489);
        let draws: Vec<u32> = (0..10_000).map(|_| generator.draw()).collect();
        assert_eq!((draws[0], draws[9999]), (3_499_211_612, 4_123_659_995));
        // RandomState(891374).rand(), three times; RandomState(125487).shuffle(list(range(12)))
        let mut generator = RandomState::new(891_374);
        assert_eq!([(); 3].map(|()| generator.uniform()), [0.5669355274994579, 0.6388034889304297, 0.5673529567448476]);
        let mut values: Vec<usize> = (0..12).collect();
        RandomState::new(125_487).shuffle(&mut values);
        assert_eq!(values, [2, 8, 3, 6, 11, 5, 7, 10, 9, 0, 1, 4]);
    }
}
