//! Structs as messages of Protocol Buffers, by one table of numbers a struct.

use prost::encoding::{self, DecodeContext, WireType};
use prost::{DecodeError, Message};
use prost_types::{DescriptorProto, FieldDescriptorProto, FileDescriptorProto, FileDescriptorSet};

use crate::field::Field;
use messages::{Header, Stamps};

/// The package of all schemas.
pub(crate) const PACKAGE: &str = "deckflex";

/// A struct that stands in a recording.
pub(crate) trait Structure {
    /// Its name in the package.
    const NAME: &'static str;
    /// Its fields, for the schema.
    fn fields() -> Vec<FieldDescriptorProto>;
    /// Writes all fields.
    fn encode(&self, out: &mut Vec<u8>);
    /// The names of its columns in a table.
    fn columns() -> Vec<String>;
    /// Its values in these columns.
    fn values(&self, out: &mut Vec<String>);
    /// Takes one field; `false` if the number is not known.
    fn merge(&mut self, number: u32, wire: WireType, input: &mut &[u8]) -> Result<bool, DecodeError>;
}

/// Gives each field its number, which must never change; types and names are those of the struct.
macro_rules! structure {
    ($type:ident { $($number:literal $field:ident),* } $(left out { $($left:ident),* })?) => {
        impl $crate::structure::Structure for $type {
            const NAME: &'static str = stringify!($type);
            fn fields() -> Vec<prost_types::FieldDescriptorProto> {
                let of = Self::default();
                vec![$($crate::structure::describe(stringify!($field), $number, &of.$field)),*]
            }
            fn encode(&self, out: &mut Vec<u8>) {
                // a field that the struct gets and this table does not is an error here
                let Self { $($field,)* $($($left: _),*)? } = self;
                $($crate::field::Field::write($field, $number, out);)*
            }
            fn columns() -> Vec<String> {
                let of = Self::default();
                [$($crate::structure::columns(stringify!($field), &of.$field)),*].concat()
            }
            fn values(&self, out: &mut Vec<String>) {
                $($crate::field::Field::values(&self.$field, out);)*
            }
            fn merge(
                &mut self,
                number: u32,
                wire: prost::encoding::WireType,
                input: &mut &[u8],
            ) -> Result<bool, prost::DecodeError> {
                match number {
                    $($number => $crate::field::Field::read(&mut self.$field, wire, input)?,)*
                    _ => return Ok(false),
                }
                Ok(true)
            }
        }
    };
}
pub(crate) use structure;

pub(crate) fn describe<F: Field>(name: &str, number: i32, _: &F) -> FieldDescriptorProto {
    FieldDescriptorProto {
        name: Some(name.to_owned()),
        number: Some(number),
        label: Some(F::LABEL as i32),
        r#type: Some(F::TYPE as i32),
        type_name: F::STRUCTURE.map(|name| format!(".{PACKAGE}.{name}")),
        ..FieldDescriptorProto::default()
    }
}

pub(crate) fn columns<F: Field>(name: &str, _: &F) -> Vec<String> {
    F::columns(name)
}

/// Takes all fields of a message; unknown ones, of a later version, are passed over.
pub(crate) fn merge_all<S: Structure>(structure: &mut S, mut input: &[u8]) -> Result<(), DecodeError> {
    while !input.is_empty() {
        let (number, wire) = encoding::decode_key(&mut input)?;
        if !structure.merge(number, wire, &mut input)? {
            encoding::skip_field(wire, number, &mut input, DecodeContext::default())?;
        }
    }
    Ok(())
}

/// The schema of a message as readers want it: a set of descriptors, complete with what the message is made of.
pub(crate) fn schema<S: Structure>() -> Vec<u8> {
    fn message<S: Structure>() -> DescriptorProto {
        DescriptorProto { name: Some(S::NAME.to_owned()), field: S::fields(), ..DescriptorProto::default() }
    }
    let file = FileDescriptorProto {
        name: Some(format!("{PACKAGE}/{}.proto", S::NAME)),
        package: Some(PACKAGE.to_owned()),
        message_type: vec![message::<Stamps>(), message::<Header>(), message::<S>()],
        syntax: Some("proto3".to_owned()),
        ..FileDescriptorProto::default()
    };
    FileDescriptorSet { file: vec![file] }.encode_to_vec()
}
