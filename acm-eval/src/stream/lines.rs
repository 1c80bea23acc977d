//! Lines of a stream that may never end, in bounded memory.

use std::io::{self, BufRead, ErrorKind};

/// Bytes of a line at most: a sample of a thousand signals takes about 25 kB. What is longer is no line of samples, and is passed
/// over up to the next newline.
pub const LONGEST_LINE: usize = 1 << 20;

/// Reader of lines, one after the other, in a buffer that they share.
pub struct Lines<R> {
    stream: R,
    bytes: Vec<u8>,
    number: u64,
    /// Whether the rest of the last line is still in the stream.
    unread: bool,
}

/// One line.
#[derive(Debug, PartialEq, Eq)]
pub struct Line<'a> {
    /// Number of the line, from 1.
    pub number: u64,
    /// Bytes without the line's end; of a line that is too long its beginning.
    pub bytes: &'a [u8],
    /// Whether it is no longer than [`LONGEST_LINE`].
    pub whole: bool,
}

impl<R: BufRead> Lines<R> {
    /// Returns a reader before the first line.
    pub fn new(stream: R) -> Self {
        Self { stream, bytes: vec![], number: 0, unread: false }
    }

    /// Returns the next line, none at the end. A line that is too long is returned as soon as it is known to be too
    /// long.
    ///
    /// # Errors
    /// The stream cannot be read.
    pub fn next(&mut self) -> io::Result<Option<Line<'_>>> {
        while self.unread {
            self.piece(0)?;
        }
        self.bytes.clear();
        self.unread = true;
        while self.unread && self.bytes.len() <= LONGEST_LINE {
            let ended = self.piece(LONGEST_LINE + 1)?;
            if ended && self.bytes.is_empty() {
                return Ok(None);
            }
        }
        self.number += 1;
        let whole = self.bytes.len() <= LONGEST_LINE;
        let bytes = self.bytes.strip_suffix(b"\r").unwrap_or(&self.bytes);
        Ok(Some(Line { number: self.number, bytes, whole }))
    }

    /// Takes a piece of the stream up to the end of the line, and keeps at most `most` bytes of the line; returns
    /// whether the stream has ended.
    fn piece(&mut self, most: usize) -> io::Result<bool> {
        let piece = loop {
            match self.stream.fill_buf() {
                Err(error) if error.kind() == ErrorKind::Interrupted => {}
                other => break other?,
            }
        };
        let end = piece.iter().position(|byte| *byte == b'\n');
        let line = &piece[..end.unwrap_or(piece.len())];
        let room = most.saturating_sub(self.bytes.len());
        self.bytes.extend_from_slice(&line[..line.len().min(room)]);
        let (ended, taken) = (piece.is_empty(), line.len() + usize::from(end.is_some()));
        self.stream.consume(taken);
        self.unread = end.is_none() && !ended;
        Ok(ended)
    }
}

#[cfg(test)]
mod tests {
    use std::io::{BufReader, repeat};

    use super::*;

    /// Returns number, bytes and completeness of every line, read in pieces of `piece` bytes.
    fn all(text: &[u8], piece: usize) -> Vec<(u64, Vec<u8>, bool)> {
        let mut lines = Lines::new(BufReader::with_capacity(piece, text));
        let mut found = vec![];
        while let Some(Line { number, bytes, whole }) = lines.next().unwrap() {
            found.push((number, bytes.to_vec(), whole));
        }
        found
    }

    #[test]
    fn lines_end_with_a_newline_or_with_the_stream() {
        for piece in [1, 2, 3, 64] {
            let found = all(b"a,b\r\n\n\xff\nlast", piece);
            let expected: [&[u8]; 4] = [b"a,b", b"", b"\xff", b"last"];
            assert_eq!(found.len(), 4);
            for (k, (number, bytes, whole)) in found.iter().enumerate() {
                assert_eq!((*number, bytes.as_slice(), *whole), (k as u64 + 1, expected[k], true));
            }
        }
        assert!(all(b"", 4).is_empty());
    }

    #[test]
    fn the_line_after_one_that_is_too_long_is_read() {
        for (length, whole) in [(LONGEST_LINE, true), (LONGEST_LINE + 1, false), (3 * LONGEST_LINE, false)] {
            let text = [vec![b'x'; length], b"\nnext\n".to_vec()].concat();
            let found = all(&text, 1 << 16);
            assert_eq!((found.len(), found[0].2), (2, whole), "{length} bytes");
            assert_eq!(found[1], (2, b"next".to_vec(), true));
        }
    }

    #[test]
    fn a_line_without_end_is_told_before_it_ends() {
        let mut lines = Lines::new(BufReader::new(repeat(b'x')));
        let line = lines.next().unwrap().unwrap();
        assert!(!line.whole && line.bytes.len() <= LONGEST_LINE + 1);
        assert!(lines.bytes.capacity() <= 4 * LONGEST_LINE);
    }
}
