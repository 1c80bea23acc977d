//! Thrift's compact protocol, as far as the footers and page headers of Parquet files need it: bytes in, a tree of values out.
//!
//! Nothing is allocated that the bytes do not hold: a list cannot have more members than there are bytes left, and nothing is
//! nested deeper than [`DEEPEST`].

/// Parquet's own structures are seven deep.
const DEEPEST: usize = 24;

/// A value; of the fields of a structure, those that are there, by number.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Value<'a> {
    Number(i64),
    Bytes(&'a [u8]),
    List(Vec<Value<'a>>),
    Structure(Vec<(i64, Value<'a>)>),
    /// Types that this reader does not need: booleans, floating-point numbers, maps.
    Other,
}

impl<'a> Value<'a> {
    /// A field of a structure.
    pub fn field(&self, number: i64) -> Option<&Value<'a>> {
        match self {
            Value::Structure(fields) => fields.iter().find(|(n, _)| *n == number).map(|(_, value)| value),
            _ => None,
        }
    }

    /// A field that is a whole number.
    pub fn number(&self, number: i64) -> Option<i64> {
        match self.field(number)? {
            Value::Number(value) => Some(*value),
            _ => None,
        }
    }

    /// The members of a field that is a list; none where it is missing.
    pub fn list(&self, number: i64) -> &[Value<'a>] {
        match self.field(number) {
            Some(Value::List(members)) => members,
            _ => &[],
        }
    }

    /// A value that is text.
    pub fn text(&self) -> Option<String> {
        match self {
            Value::Bytes(bytes) => Some(String::from_utf8_lossy(bytes).into_owned()),
            _ => None,
        }
    }
}

/// The structure at the start of `bytes`, and how many bytes it takes; none where it breaks off or is none.
pub(super) fn structure(bytes: &[u8]) -> Option<(Value<'_>, usize)> {
    let mut reader = Reader { bytes, at: 0 };
    let value = reader.structure(0)?;
    Some((value, reader.at))
}

struct Reader<'a> {
    bytes: &'a [u8],
    at: usize,
}

impl<'a> Reader<'a> {
    fn byte(&mut self) -> Option<u8> {
        let byte = *self.bytes.get(self.at)?;
        self.at += 1;
        Some(byte)
    }

    fn take(&mut self, count: usize) -> Option<&'a [u8]> {
        let bytes = self.bytes.get(self.at..self.at.checked_add(count)?)?;
        self.at += count;
        Some(bytes)
    }

    fn varint(&mut self) -> Option<u64> {
        let mut value = 0;
        for shift in (0..70).step_by(7) {
            let byte = self.byte()?;
            value |= u64::from(byte & 0x7f).checked_shl(shift).unwrap_or(0);
            if byte < 0x80 {
                return Some(value);
            }
        }
        None
    }

    fn zigzag(&mut self) -> Option<i64> {
        let value = self.varint()?;
        Some((value >> 1) as i64 ^ -((value & 1) as i64))
    }

    fn structure(&mut self, depth: usize) -> Option<Value<'a>> {
        let (mut fields, mut number) = (Vec::new(), 0i64);
        loop {
            let head = self.byte()?;
            if head == 0 {
                return Some(Value::Structure(fields));
            }
            number = match head >> 4 {
                0 => self.zigzag()?,
                step => number.checked_add(i64::from(step))?,
            };
            // the truth of a field stands in its head
            let value = if matches!(head & 15, 1 | 2) { Value::Other } else { self.value(head & 15, depth + 1)? };
            fields.push((number, value));
        }
    }

    fn value(&mut self, kind: u8, depth: usize) -> Option<Value<'a>> {
        if depth > DEEPEST {
            return None;
        }
        match kind {
            1..=3 => self.byte().map(|byte| Value::Number(i64::from(byte as i8))),
            4..=6 => self.zigzag().map(Value::Number),
            7 => self.take(8).map(|_| Value::Other),
            8 => {
                let length = usize::try_from(self.varint()?).ok()?;
                self.take(length).map(Value::Bytes)
            }
            9 | 10 => self.members(depth),
            11 => self.map(depth),
            12 => self.structure(depth),
            _ => None,
        }
    }

    fn members(&mut self, depth: usize) -> Option<Value<'a>> {
        let head = self.byte()?;
        let count = match head >> 4 {
            15 => usize::try_from(self.varint()?).ok()?,
            count => usize::from(count),
        };
        if count > self.bytes.len() - self.at {
            return None;
        }
        (0..count).map(|_| self.value(head & 15, depth + 1)).collect::<Option<Vec<_>>>().map(Value::List)
    }

    fn map(&mut self, depth: usize) -> Option<Value<'a>> {
        let count = usize::try_from(self.varint()?).ok()?;
        if count > self.bytes.len() - self.at {
            return None;
        }
        if count > 0 {
            let kinds = self.byte()?;
            for _ in 0..count {
                self.value(kinds >> 4, depth + 1)?;
                self.value(kinds & 15, depth + 1)?;
            }
        }
        Some(Value::Other)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: the bytes written by hand after the protocol's description. Field 1 is −3, field 2 the list [1, 300], field 20
    /// the text "ab".
    #[test]
    fn numbers_lists_and_text() {
        let bytes = [0x15, 0x05, 0x19, 0x25, 0x02, 0xd8, 0x04, 0x08, 0x28, 0x02, b'a', b'b', 0x00, 0xff];
        let (value, length) = structure(&bytes).unwrap_or((Value::Other, 0));
        assert_eq!(length, bytes.len() - 1);
        assert_eq!(value.number(1), Some(-3));
        assert_eq!(value.list(2), [Value::Number(1), Value::Number(300)]);
        assert_eq!(value.field(20).and_then(Value::text).as_deref(), Some("ab"));
        for end in 0..length {
            assert_eq!(structure(&bytes[..end]), None, "broken off after {end} bytes");
        }
    }

    #[test]
    fn what_the_bytes_do_not_hold_is_refused() {
        // a list of 2⁶³ numbers, a text of as many bytes, structures without end
        assert_eq!(structure(&[0x19, 0xf5, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0x7f]), None);
        assert_eq!(structure(&[0x18, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0x7f]), None);
        assert_eq!(structure(&[0x1c; 100_000]), None);
    }
}
