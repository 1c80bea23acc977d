//! What one message holds: its numbers and texts in the order of the bytes, and, where that is asked for, their paths.

use re_cdr::{BigEndian, CdrReader, LittleEndian};

use super::fields::{Visit, Walk};
use super::layout::Item;
use crate::error::short;

/// Numbers and texts of a message, at most.
pub(super) const WIDEST: usize = 4096;

/// Numbers and texts of a message. Two messages of a channel with the same `lengths` hold the same fields.
#[derive(Default)]
pub(super) struct Values<'a> {
    pub numbers: Vec<f64>,
    pub texts: Vec<&'a str>,
    /// Elements of each array that messages may have more or fewer of.
    pub lengths: Vec<usize>,
}

impl<'a> Visit<'a> for Values<'a> {
    fn field(&mut self, _: &str) {}

    fn element(&mut self, _: usize) {}

    fn leave(&mut self) {}

    fn length(&mut self, count: usize) {
        self.lengths.push(count);
    }

    fn number(&mut self, value: f64) {
        if self.numbers.len() < WIDEST {
            self.numbers.push(value);
        }
    }

    fn text(&mut self, text: &'a str) {
        if self.texts.len() < WIDEST {
            self.texts.push(text);
        }
    }
}

/// Paths of the numbers and texts of a message, such as `pose.position.x` and `position[3]`.
#[derive(Default)]
pub(super) struct Paths {
    pub numbers: Vec<String>,
    pub texts: Vec<String>,
    path: String,
    /// Lengths of the path before each field or element that is open.
    open: Vec<usize>,
}

impl<'a> Visit<'a> for Paths {
    fn field(&mut self, name: &str) {
        self.open.push(self.path.len());
        if !self.path.is_empty() {
            self.path.push('.');
        }
        self.path.push_str(name);
    }

    fn element(&mut self, index: usize) {
        self.open.push(self.path.len());
        self.path.push_str(&format!("[{index}]"));
    }

    fn leave(&mut self) {
        self.path.truncate(self.open.pop().unwrap_or(0));
    }

    fn length(&mut self, _: usize) {}

    fn number(&mut self, _: f64) {
        if self.numbers.len() < WIDEST {
            self.numbers.push(self.path.clone());
        }
    }

    fn text(&mut self, _: &'a str) {
        if self.texts.len() < WIDEST {
            self.texts.push(self.path.clone());
        }
    }
}

/// Walks over a message in the encoding that its first four bytes declare.
pub(super) fn read<'a, V: Visit<'a> + Default>(layout: &Item, data: &'a [u8]) -> Result<V, String> {
    let mut visit = V::default();
    let (Some(little), Some(body)) = (data.get(1), data.get(4..)) else {
        return Err("it is shorter than its head".into());
    };
    let done = match little & 1 {
        1 => Walk { reader: CdrReader::<LittleEndian>::new(body), visit: &mut visit }.item(layout, 0),
        _ => Walk { reader: CdrReader::<BigEndian>::new(body), visit: &mut visit }.item(layout, 0),
    };
    done.map(|()| visit).map_err(|e| short(&e.to_string(), 80))
}
