//! Ways in which a file comes to be another: flipped bits, lost and doubled pieces, edits of headers and of values.

use rand::{RngExt, seq::IndexedRandom};
use rand_chacha::ChaCha8Rng;

/// One way, by name.
#[derive(Debug, Clone, Copy)]
pub struct Mutation {
    /// For people.
    pub name: &'static str,
    /// The bytes after it; they may be the same by chance.
    pub apply: fn(&[u8], &mut ChaCha8Rng) -> Vec<u8>,
}

/// All ways.
pub const ALL: &[Mutation] = &[
    Mutation { name: "flipped bit", apply: flipped_bit },
    Mutation {
        name: "flipped bits",
        apply: |bytes, random| (0..8).fold(bytes.to_vec(), |b, _| flipped_bit(&b, random)),
    },
    Mutation { name: "flipped bit in the first kilobyte", apply: flipped_early },
    Mutation { name: "inserted bytes", apply: inserted },
    Mutation { name: "lost bytes", apply: lost },
    Mutation { name: "cut off", apply: |bytes, random| bytes[..random.random_range(0..bytes.len())].to_vec() },
    Mutation { name: "bytes behind the end", apply: appended },
    Mutation { name: "swapped blocks", apply: swapped },
    Mutation { name: "doubled block", apply: doubled },
    Mutation { name: "zeroed block", apply: zeroed },
    Mutation { name: "another length of the header", apply: header_length },
    Mutation { name: "another digit", apply: another_digit },
    Mutation { name: "another letter", apply: another_letter },
    Mutation { name: "lost line", apply: lost_line },
    Mutation { name: "swapped lines", apply: swapped_lines },
    Mutation { name: "doubled line", apply: doubled_line },
    Mutation { name: "more white space", apply: white_space },
    Mutation { name: "value replaced", apply: value_replaced },
];

/// The place of a piece of a file.
fn piece(bytes: &[u8], random: &mut ChaCha8Rng) -> std::ops::Range<usize> {
    let length = random.random_range(1..=bytes.len().min(512));
    let start = random.random_range(0..=bytes.len() - length);
    start..start + length
}

fn flipped_bit(bytes: &[u8], random: &mut ChaCha8Rng) -> Vec<u8> {
    let mut bytes = bytes.to_vec();
    let at = random.random_range(0..bytes.len());
    bytes[at] ^= 1 << random.random_range(0..8);
    bytes
}

fn flipped_early(bytes: &[u8], random: &mut ChaCha8Rng) -> Vec<u8> {
    let mut bytes = bytes.to_vec();
    let at = random.random_range(0..bytes.len().min(1024));
    bytes[at] ^= 1 << random.random_range(0..8);
    bytes
}

fn inserted(bytes: &[u8], random: &mut ChaCha8Rng) -> Vec<u8> {
    let at = random.random_range(0..=bytes.len());
    let new: Vec<u8> = (0..random.random_range(1..=16)).map(|_| random.random()).collect();
    [&bytes[..at], &new, &bytes[at..]].concat()
}

fn lost(bytes: &[u8], random: &mut ChaCha8Rng) -> Vec<u8> {
    let lost = piece(bytes, random);
    [&bytes[..lost.start], &bytes[lost.end..]].concat()
}

fn appended(bytes: &[u8], random: &mut ChaCha8Rng) -> Vec<u8> {
    let new: Vec<u8> = match random.random_range(0..3) {
        0 => vec![b'\n'],
        1 => bytes.to_vec(),
        _ => (0..random.random_range(1..=64)).map(|_| random.random()).collect(),
    };
    [bytes, &new].concat()
}

fn swapped(bytes: &[u8], random: &mut ChaCha8Rng) -> Vec<u8> {
    let mut bytes = bytes.to_vec();
    let length = random.random_range(1..=(bytes.len() / 2).min(512));
    let first = random.random_range(0..=bytes.len() - 2 * length);
    let second = random.random_range(first + length..=bytes.len() - length);
    let (before, after) = bytes.split_at_mut(second);
    before[first..first + length].swap_with_slice(&mut after[..length]);
    bytes
}

fn doubled(bytes: &[u8], random: &mut ChaCha8Rng) -> Vec<u8> {
    let piece = piece(bytes, random);
    [&bytes[..piece.end], &bytes[piece.start..]].concat()
}

fn zeroed(bytes: &[u8], random: &mut ChaCha8Rng) -> Vec<u8> {
    let (mut bytes, piece) = (bytes.to_vec(), piece(bytes, random));
    bytes[piece].fill(0);
    bytes
}

/// The first eight bytes of a safetensors file say how long its header is: here up to 2⁶⁴ − 1.
fn header_length(bytes: &[u8], random: &mut ChaCha8Rng) -> Vec<u8> {
    let claimed: u64 = match random.random_range(0..4) {
        0 => 10_000_000_000,
        1 => u64::MAX,
        2 => random.random_range(0..2 * bytes.len() as u64),
        _ => random.random(),
    };
    let mut bytes = bytes.to_vec();
    let first = bytes.len().min(8);
    bytes[..first].copy_from_slice(&claimed.to_le_bytes()[..first]);
    bytes
}

fn another(bytes: &[u8], random: &mut ChaCha8Rng, of: fn(&u8) -> bool, to: std::ops::RangeInclusive<u8>) -> Vec<u8> {
    let places: Vec<usize> = (0..bytes.len()).filter(|&at| of(&bytes[at])).collect();
    let mut bytes = bytes.to_vec();
    if let Some(&at) = places.choose(random) {
        bytes[at] = random.random_range(to);
    }
    bytes
}

fn another_digit(bytes: &[u8], random: &mut ChaCha8Rng) -> Vec<u8> {
    another(bytes, random, u8::is_ascii_digit, b'0'..=b'9')
}

fn another_letter(bytes: &[u8], random: &mut ChaCha8Rng) -> Vec<u8> {
    another(bytes, random, u8::is_ascii_lowercase, b'a'..=b'z')
}

/// Lines with their ends.
fn lines(bytes: &[u8]) -> Vec<&[u8]> {
    bytes.split_inclusive(|&byte| byte == b'\n').collect()
}

fn lost_line(bytes: &[u8], random: &mut ChaCha8Rng) -> Vec<u8> {
    let mut lines = lines(bytes);
    lines.remove(random.random_range(0..lines.len()));
    lines.concat()
}

fn swapped_lines(bytes: &[u8], random: &mut ChaCha8Rng) -> Vec<u8> {
    let mut lines = lines(bytes);
    let [a, b] = [0, 1].map(|_| random.random_range(0..lines.len()));
    lines.swap(a, b);
    lines.concat()
}

fn doubled_line(bytes: &[u8], random: &mut ChaCha8Rng) -> Vec<u8> {
    let mut lines = lines(bytes);
    let at = random.random_range(0..lines.len());
    lines.insert(at, lines[at]);
    lines.concat()
}

/// What an editor or another operating system does to a text.
fn white_space(bytes: &[u8], random: &mut ChaCha8Rng) -> Vec<u8> {
    match random.random_range(0..3) {
        0 => [b"\xef\xbb\xbf", bytes].concat(),
        1 => lines(bytes)
            .iter()
            .flat_map(|line| line.strip_suffix(b"\n").map_or(line.to_vec(), |l| [l, b"\r\n"].concat()))
            .collect(),
        _ => {
            let places: Vec<usize> = (0..bytes.len()).filter(|&at| bytes[at] == b' ').collect();
            let at = places.choose(random).copied().unwrap_or(0);
            [&bytes[..at], b" ", &bytes[at..]].concat()
        }
    }
}

/// Another value behind a colon: what somebody does who wants another result.
fn value_replaced(bytes: &[u8], random: &mut ChaCha8Rng) -> Vec<u8> {
    let colons: Vec<usize> = (0..bytes.len()).filter(|&at| bytes[at] == b':').collect();
    let Some(&colon) = colons.choose(random) else { return flipped_bit(bytes, random) };
    let ends = |byte: &u8| b",}\n".contains(byte);
    let end = bytes[colon..].iter().position(ends).map_or(bytes.len(), |length| colon + length);
    let values: [&[u8]; 8] = [b" 0", b" 1e300", b" null", b" true", b" \"\"", b" []", b" -1", b" 0.001"];
    let value = values.choose(random).copied().unwrap_or(b" 0");
    [&bytes[..=colon], value, &bytes[end..]].concat()
}
