//! The layout of a message, from its schema: a tree of fields in the order of the bytes.

use std::collections::BTreeMap;
use std::rc::Rc;

use re_ros_msg::MessageSchema;
use re_ros_msg::message_spec::{ArraySize, BuiltInType, ComplexType, MessageSpecification, Type, message_package};

/// One field, or one element of an array.
#[derive(Debug, Clone)]
pub(super) enum Item {
    /// A number.
    Number(BuiltInType),
    /// UTF-8.
    Text,
    /// Fields by name.
    Message(Rc<[(String, Item)]>),
    /// Elements of one type; without a count, their number stands before them.
    Array { of: Rc<Item>, count: Option<usize> },
    /// A field that cannot be read, and why.
    Refused(String),
}

/// The field that a message without fields has on the wire.
const PADDING: &str = "structure_needs_at_least_one_member";

/// The layout of a channel's messages.
pub(super) fn layout(schema: &MessageSchema) -> Item {
    Layouts { schema, known: BTreeMap::new() }.message(&schema.spec)
}

/// Layouts of the types of a schema; each type has one, however often it occurs.
struct Layouts<'s> {
    schema: &'s MessageSchema,
    /// None while a type is laid out.
    known: BTreeMap<&'s str, Option<Item>>,
}

impl<'s> Layouts<'s> {
    fn message(&mut self, spec: &'s MessageSpecification) -> Item {
        match self.known.get(spec.name.as_str()) {
            Some(Some(known)) => return known.clone(),
            Some(None) => return Item::Refused("messages within messages without end".into()),
            None => self.known.insert(&spec.name, None),
        };
        let own = spec.fields.iter().filter(|field| field.name != PADDING);
        let fields = own.map(|field| (field.name.clone(), self.item(spec, &field.ty))).collect();
        let laid = Item::Message(fields);
        self.known.insert(&spec.name, Some(laid.clone()));
        laid
    }

    fn item(&mut self, scope: &MessageSpecification, ty: &Type) -> Item {
        match ty {
            Type::BuiltIn(builtin) => scalar(builtin),
            Type::Complex(complex) => self.named(scope, complex),
            Type::Array { ty, size } => {
                let count = match size {
                    ArraySize::Fixed(count) => Some(*count),
                    ArraySize::Bounded(_) | ArraySize::Unbounded => None,
                };
                Item::Array { of: Rc::new(self.item(scope, ty)), count }
            }
        }
    }

    fn named(&mut self, scope: &MessageSpecification, complex: &ComplexType) -> Item {
        let name = match complex {
            ComplexType::Absolute { package, name } => format!("{package}/{name}"),
            ComplexType::Relative { name } => match message_package(&scope.name) {
                Some(package) => format!("{package}/{name}"),
                None => name.clone(),
            },
        };
        // `pkg/msg/Name` and `pkg/Name` are one type.
        let bare = |full: &str| full.replacen("/msg/", "/", 1);
        let Some(spec) = self.schema.dependencies.iter().find(|spec| bare(&spec.name) == bare(&name)) else {
            return Item::Refused(format!("the schema has no type {name}"));
        };
        match spec.underlying_type_if_enum_like() {
            Ok(Some(builtin)) => scalar(&builtin.clone()),
            Ok(None) => self.message(spec),
            Err(error) => Item::Refused(error.to_string()),
        }
    }
}

fn scalar(ty: &BuiltInType) -> Item {
    match ty {
        BuiltInType::String(_) => Item::Text,
        BuiltInType::WString(_) => Item::Refused("text of type wstring is not read".into()),
        number => Item::Number(number.clone()),
    }
}
