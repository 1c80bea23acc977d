//! A walk over the bytes of a message (CDR).
//!
//! Arrays of more than [`LONGEST`] numbers are skipped: images and clouds of points are no columns.

use re_cdr::{CdrEndian, CdrReader, Error, Result};
use re_ros_msg::message_spec::BuiltInType;

use super::layout::Item;

/// Longer arrays are skipped.
const LONGEST: usize = 256;

/// Messages within messages.
const DEEPEST: usize = 32;

/// Visitor of the fields of a message.
pub(super) trait Visit<'a> {
    /// What follows, up to [`Visit::leave`], is the field of this name.
    fn field(&mut self, name: &str);
    /// What follows is the element of this index.
    fn element(&mut self, index: usize);
    /// The end of a field or an element.
    fn leave(&mut self);
    /// Number of elements of an array that messages may have more or fewer of.
    fn length(&mut self, count: usize);
    /// A number.
    fn number(&mut self, value: f64);
    /// A text.
    fn text(&mut self, text: &'a str);
}

/// Bytes of a message, and what looks at them.
pub(super) struct Walk<'a, 'v, BO, V> {
    pub reader: CdrReader<'a, BO>,
    pub visit: &'v mut V,
}

impl<'a, BO: CdrEndian, V: Visit<'a>> Walk<'a, '_, BO, V> {
    /// All that an item holds.
    pub fn item(&mut self, item: &Item, depth: usize) -> Result<()> {
        match item {
            Item::Number(ty) => self.number(ty),
            Item::Text => self.reader.read_str().map(|text| self.visit.text(text)),
            Item::Message(fields) => self.message(fields, depth),
            Item::Array { of, count } => self.array(of, *count, depth),
            Item::Refused(why) => Err(Error::Custom(why.clone())),
        }
    }

    fn message(&mut self, fields: &[(String, Item)], depth: usize) -> Result<()> {
        if depth > DEEPEST {
            return Err(Error::Custom("messages within messages without end".into()));
        }
        if fields.is_empty() {
            return self.reader.read_u8().map(drop); // the wire has no structure without a member
        }
        for (name, item) in fields {
            self.visit.field(name);
            self.item(item, depth + 1)?;
            self.visit.leave();
        }
        Ok(())
    }

    fn array(&mut self, of: &Item, count: Option<usize>, depth: usize) -> Result<()> {
        let count = match count {
            Some(count) => count,
            None => {
                let count = self.reader.read_sequence_length()?;
                self.visit.length(count);
                count
            }
        };
        if let (Item::Number(ty), true) = (of, count > LONGEST) {
            self.reader.align(width(ty))?;
            let bytes = count.checked_mul(width(ty)).ok_or_else(|| Error::Custom("an array without end".into()))?;
            return self.reader.read_bytes(bytes).map(drop);
        }
        // Every element takes a byte or more.
        if count > self.reader.remaining() {
            return Err(Error::Custom(format!("an array of {count} in {} bytes", self.reader.remaining())));
        }
        for index in 0..count {
            self.visit.element(index);
            self.item(of, depth)?;
            self.visit.leave();
        }
        Ok(())
    }

    fn number(&mut self, ty: &BuiltInType) -> Result<()> {
        let reader = &mut self.reader;
        let value = match ty {
            BuiltInType::Bool => f64::from(u8::from(reader.read_bool()?)),
            BuiltInType::Byte | BuiltInType::Char | BuiltInType::UInt8 => f64::from(reader.read_u8()?),
            BuiltInType::Int8 => f64::from(reader.read_i8()?),
            BuiltInType::Int16 => f64::from(reader.read_i16()?),
            BuiltInType::UInt16 => f64::from(reader.read_u16()?),
            BuiltInType::Int32 => f64::from(reader.read_i32()?),
            BuiltInType::UInt32 => f64::from(reader.read_u32()?),
            BuiltInType::Int64 => reader.read_i64()? as f64,
            BuiltInType::UInt64 => reader.read_u64()? as f64,
            BuiltInType::Float32 => f64::from(reader.read_f32()?),
            BuiltInType::Float64 => reader.read_f64()?,
            BuiltInType::String(_) | BuiltInType::WString(_) => unreachable!("texts are no numbers"),
        };
        self.visit.number(value);
        Ok(())
    }
}

/// Bytes of a number on the wire.
fn width(ty: &BuiltInType) -> usize {
    match ty {
        BuiltInType::Int16 | BuiltInType::UInt16 => 2,
        BuiltInType::Int32 | BuiltInType::UInt32 | BuiltInType::Float32 => 4,
        BuiltInType::Int64 | BuiltInType::UInt64 | BuiltInType::Float64 => 8,
        _ => 1,
    }
}
