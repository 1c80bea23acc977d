//! The numbers of a message, by its schema: a walk over its bytes (CDR).
//!
//! Text is passed over, and so are arrays of more than [`LONGEST`] numbers: images and clouds of points are no columns.

use re_cdr::{CdrEndian, CdrReader, Error, Result};
use re_ros_msg::MessageSchema;
use re_ros_msg::message_spec::{ArraySize, BuiltInType, ComplexType, MessageSpecification, Type, message_package};

/// Longer arrays are passed over.
const LONGEST: usize = 256;

/// Messages within messages.
const DEEPEST: usize = 32;

/// Visitor of the fields of a message.
pub(super) trait Visit {
    /// A number and its path, `pose.position.x`.
    fn number(&mut self, path: &str, value: f64);
    /// A text and its path.
    fn text(&mut self, path: &str, text: &str);
}

/// A message's bytes, and what they say.
pub(super) struct Walk<'a, 'b, BO, V> {
    pub reader: CdrReader<'a, BO>,
    pub schema: &'b MessageSchema,
    pub visit: &'b mut V,
    pub path: String,
}

impl<'b, BO: CdrEndian, V: Visit> Walk<'_, 'b, BO, V> {
    /// All fields of a message.
    pub fn message(&mut self, spec: &MessageSpecification, depth: usize) -> Result<()> {
        if depth > DEEPEST {
            return Err(Error::Custom("messages within messages without end".into()));
        }
        if spec.fields.is_empty() {
            return self.reader.read_u8().map(drop); // the wire has no structure without a member
        }
        for field in &spec.fields {
            let length = self.path.len();
            if length > 0 {
                self.path.push('.');
            }
            self.path.push_str(&field.name);
            self.value(spec, &field.ty, depth)?;
            self.path.truncate(length);
        }
        Ok(())
    }

    fn value(&mut self, scope: &MessageSpecification, ty: &Type, depth: usize) -> Result<()> {
        match ty {
            Type::BuiltIn(builtin) => self.scalar(builtin),
            Type::Complex(complex) => {
                let spec = self.resolve(scope, complex)?;
                let alike = spec.underlying_type_if_enum_like().map_err(|e| Error::Custom(e.to_string()))?;
                match alike {
                    Some(builtin) => self.scalar(builtin),
                    None => self.message(spec, depth + 1),
                }
            }
            Type::Array { ty, size } => {
                let count = match size {
                    ArraySize::Fixed(count) => *count,
                    _ => self.reader.read_sequence_length()?,
                };
                self.array(scope, ty, count, depth)
            }
        }
    }

    fn array(&mut self, scope: &MessageSpecification, ty: &Type, count: usize, depth: usize) -> Result<()> {
        if let (Type::BuiltIn(builtin), true) = (ty, count > LONGEST) {
            if let Some(width) = width(builtin) {
                self.reader.align(width)?;
                let bytes = count.checked_mul(width).ok_or_else(|| Error::Custom("an array without end".into()))?;
                return self.reader.read_bytes(bytes).map(drop);
            }
        }
        // every element takes a byte or more
        if count > self.reader.remaining() {
            return Err(Error::Custom(format!("an array of {count} in {} bytes", self.reader.remaining())));
        }
        let length = self.path.len();
        for i in 0..count {
            self.path.push_str(&format!("[{i}]"));
            self.value(scope, ty, depth)?;
            self.path.truncate(length);
        }
        Ok(())
    }

    fn scalar(&mut self, ty: &BuiltInType) -> Result<()> {
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
            BuiltInType::String(_) => {
                let text = reader.read_str()?;
                self.visit.text(&self.path, text);
                return Ok(());
            }
            BuiltInType::WString(_) => return Err(Error::Custom("text of type wstring is not read".into())),
        };
        self.visit.number(&self.path, value);
        Ok(())
    }

    fn resolve(&self, scope: &MessageSpecification, complex: &ComplexType) -> Result<&'b MessageSpecification> {
        let name = match complex {
            ComplexType::Absolute { package, name } => format!("{package}/{name}"),
            ComplexType::Relative { name } => match message_package(&scope.name) {
                Some(package) => format!("{package}/{name}"),
                None => name.clone(),
            },
        };
        // `pkg/msg/Name` and `pkg/Name` are one
        let bare = |full: &str| full.replacen("/msg/", "/", 1);
        let found = self.schema.dependencies.iter().find(|spec| bare(&spec.name) == bare(&name));
        found.ok_or_else(|| Error::Custom(format!("the schema has no type {name}")))
    }
}

/// Bytes of a number on the wire; text has none.
fn width(ty: &BuiltInType) -> Option<usize> {
    match ty {
        BuiltInType::Bool | BuiltInType::Byte | BuiltInType::Char | BuiltInType::Int8 | BuiltInType::UInt8 => Some(1),
        BuiltInType::Int16 | BuiltInType::UInt16 => Some(2),
        BuiltInType::Int32 | BuiltInType::UInt32 | BuiltInType::Float32 => Some(4),
        BuiltInType::Int64 | BuiltInType::UInt64 | BuiltInType::Float64 => Some(8),
        BuiltInType::String(_) | BuiltInType::WString(_) => None,
    }
}
