//! Damages bytes: the same seed and number give the same damage.

use rand::RngExt;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;

/// Bytes that mean something to some format.
const TOKENS: &[&[u8]] = &[
    b"\0",
    b"\n",
    b"\r\n",
    b",",
    b";",
    b"\"",
    b"'",
    b"[",
    b"]",
    b"{",
    b"}",
    b"=",
    b".",
    b"-",
    b"#",
    b"\\",
    b"\xff",
    b"\xef\xbb\xbf",
    b"\xff\xff\xff\xff",
    b"\x80\x00",
    b"\xff\xff\xff\xff\xff\xff\xff\xff\xff\x01",
    b"\xfe\xff\xff\xff\x0f",
    b"\x00\x00\x00\x80",
    b"nan",
    b"-inf",
    b"1e999",
    b"1e300",
    b"-0.0",
    b"5e-324",
    b"9223372036854775807",
    b"1764411111",
    b"3000.",
    b"-1",
    b"0x1F",
    b"1_000",
    b"true",
    b"[[",
    b"]]",
    b"[a.b.c]\n",
    b"= {",
    b"..",
    b"/",
    b"*",
    b"(",
    b")",
    b"\xe2\x80\x8b",
    b"\xe2\x80\xae",
    b"e\xcc\x81",
    b"PAR1",
    b"\x15\x00",
    b"\x19\xfc",
    b"\x16\xfe\xff\xff\xff\xff\xff\xff\xff\xff\x01",
];

/// The damage `number` of `seed` to some of the `corpus`.
pub fn damaged(corpus: &[Vec<u8>], seed: u64, number: u64) -> Vec<u8> {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    random.set_stream(number);
    let mut bytes = corpus[random.random_range(0..corpus.len())].clone();
    for _ in 0..1 << random.random_range(0..4) {
        once(&mut bytes, corpus, &mut random);
    }
    bytes
}

fn once(bytes: &mut Vec<u8>, corpus: &[Vec<u8>], random: &mut ChaCha8Rng) {
    let at = place(bytes.len(), random);
    let end = (at + (1 << random.random_range(0..10))).min(bytes.len());
    match random.random_range(0..10) {
        0 if at < bytes.len() => bytes[at] ^= 1 << random.random_range(0..8),
        1 if at < bytes.len() => bytes[at] = random.random_range(0..=255),
        2 => drop(bytes.drain(at..end)),
        3 => {
            let piece = bytes[at..end].to_vec();
            let to = place(bytes.len(), random);
            bytes.splice(to..to, piece);
        }
        4 => {
            let token = TOKENS[random.random_range(0..TOKENS.len())];
            bytes.splice(at..at, token.iter().copied());
        }
        5 => {
            let token = TOKENS[random.random_range(0..TOKENS.len())];
            let end = (at + token.len()).min(bytes.len());
            bytes.splice(at..end, token.iter().copied());
        }
        6 => bytes.truncate(at),
        7 => {
            let other = &corpus[random.random_range(0..corpus.len())];
            let from = place(other.len(), random);
            bytes.truncate(at);
            bytes.extend(&other[from..]);
        }
        8 => {
            let piece = bytes[at..end].to_vec();
            let times = 1 << random.random_range(0..8);
            bytes.splice(at..at, piece.repeat(times));
        }
        _ if at + 4 <= bytes.len() => {
            let number: u32 = [0, 1, 0x7fff_ffff, 0x8000_0000, u32::MAX][random.random_range(0..5)];
            bytes[at..at + 4].copy_from_slice(&number.to_le_bytes());
        }
        _ => {}
    }
    bytes.truncate(1 << 20);
}

/// Anywhere, and as often near the end, where some formats keep what matters.
fn place(length: usize, random: &mut ChaCha8Rng) -> usize {
    let back = random.random_range(0..=length.min(1000));
    if random.random_range(0..2) == 0 { length - back } else { random.random_range(0..=length) }
}
