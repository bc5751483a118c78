//! How the fields of a message are written and described, by their type.

use crate::structure::{Structure, merge_all};
use messages::{Alarms, Flags, Header, Stamps};
use prost::DecodeError;
use prost::bytes::{Buf, BufMut};
use prost::encoding::{self, DecodeContext, WireType};
use prost_types::field_descriptor_proto::{Label, Type};

/// A field of a message.
pub(crate) trait Field {
    /// The type in the schema.
    const TYPE: Type;
    /// Whether it stands there as a list.
    const LABEL: Label = Label::Optional;
    /// The name of the structure that it is.
    const STRUCTURE: Option<&'static str> = None;
    /// Writes it under a number.
    fn write(&self, number: u32, out: &mut Vec<u8>);
    /// Takes what was written.
    fn read(&mut self, wire: WireType, input: &mut &[u8]) -> Result<(), DecodeError>;
    /// The names of the columns that it takes in a table.
    fn columns(name: &str) -> Vec<String> {
        vec![name.to_owned()]
    }
    /// Its values in these columns, as short as they can be read back exactly.
    fn values(&self, out: &mut Vec<String>);
}

macro_rules! scalar {
    ($($type:ty: $module:ident $variant:ident),*) => {$(
        impl Field for $type {
            const TYPE: Type = Type::$variant;
            fn write(&self, number: u32, out: &mut Vec<u8>) {
                encoding::$module::encode(number, self, out);
            }
            fn read(&mut self, wire: WireType, input: &mut &[u8]) -> Result<(), DecodeError> {
                encoding::$module::merge(wire, self, input, DecodeContext::default())
            }
            fn values(&self, out: &mut Vec<String>) {
                out.push(self.to_string());
            }
        }
    )*};
}

scalar!(u32: uint32 Uint32, u64: uint64 Uint64, i64: int64 Int64, f64: double Double);

impl<const N: usize> Field for [f64; N] {
    const TYPE: Type = Type::Double;
    const LABEL: Label = Label::Repeated;

    fn write(&self, number: u32, out: &mut Vec<u8>) {
        encoding::double::encode_packed(number, self, out);
    }

    fn read(&mut self, wire: WireType, input: &mut &[u8]) -> Result<(), DecodeError> {
        encoding::wire_type::check_wire_type(WireType::LengthDelimited, wire)?;
        let mut body = delimited(input)?;
        if body.len() != 8 * N {
            return Err(error(format!("{} bytes for a list of {N} numbers", body.len())));
        }
        self.iter_mut().for_each(|x| *x = body.get_f64_le());
        Ok(())
    }

    fn columns(name: &str) -> Vec<String> {
        let axes: &[&str] = match N {
            3 => &["x", "y", "z"],
            4 => &["w", "x", "y", "z"],
            _ => &[],
        };
        let label = |i: usize| axes.get(i).map_or(i.to_string(), |axis| (*axis).to_owned());
        (0..N).map(|i| format!("{name}_{}", label(i))).collect()
    }

    fn values(&self, out: &mut Vec<String>) {
        out.extend(self.iter().map(f64::to_string));
    }
}

impl<const N: usize> Field for [u8; N] {
    const TYPE: Type = Type::Bytes;

    fn write(&self, number: u32, out: &mut Vec<u8>) {
        encoding::encode_key(number, WireType::LengthDelimited, out);
        encoding::encode_varint(N as u64, out);
        out.put_slice(self);
    }

    fn read(&mut self, wire: WireType, input: &mut &[u8]) -> Result<(), DecodeError> {
        encoding::wire_type::check_wire_type(WireType::LengthDelimited, wire)?;
        let body = delimited(input)?;
        *self = body.try_into().map_err(|_| error(format!("{} bytes for {N}", body.len())))?;
        Ok(())
    }

    fn values(&self, out: &mut Vec<String>) {
        out.push(self.iter().map(|byte| format!("{byte:02x}")).collect());
    }
}

macro_rules! flags {
    ($($type:ty),*) => {$(
        impl Field for $type {
            const TYPE: Type = Type::Uint32;

            fn write(&self, number: u32, out: &mut Vec<u8>) {
                self.bits().write(number, out);
            }

            fn read(&mut self, wire: WireType, input: &mut &[u8]) -> Result<(), DecodeError> {
                let mut bits = 0_u32;
                bits.read(wire, input)?;
                *self = Self::from_bits_retain(bits);
                Ok(())
            }

            fn values(&self, out: &mut Vec<String>) {
                out.push(self.names());
            }
        }
    )*};
}
flags!(Flags, Alarms);

macro_rules! nested {
    ($($type:ty),*) => {$(
        impl Field for $type {
            const TYPE: Type = Type::Message;
            const STRUCTURE: Option<&'static str> = Some(<$type as Structure>::NAME);
            fn write(&self, number: u32, out: &mut Vec<u8>) {
                let mut body = Vec::with_capacity(64);
                self.encode(&mut body);
                encoding::encode_key(number, WireType::LengthDelimited, out);
                encoding::encode_varint(body.len() as u64, out);
                out.put_slice(&body);
            }
            fn read(&mut self, wire: WireType, input: &mut &[u8]) -> Result<(), DecodeError> {
                encoding::wire_type::check_wire_type(WireType::LengthDelimited, wire)?;
                merge_all(self, delimited(input)?)
            }
            fn columns(_: &str) -> Vec<String> {
                <$type as Structure>::columns()
            }
            fn values(&self, out: &mut Vec<String>) {
                Structure::values(self, out);
            }
        }
    )*};
}

nested!(Header, Stamps);

/// Splits off a body that stands behind its length.
fn delimited<'a>(input: &mut &'a [u8]) -> Result<&'a [u8], DecodeError> {
    let length = encoding::decode_varint(input)?;
    let length = usize::try_from(length).ok().filter(|length| *length <= input.len());
    let (body, rest) = input.split_at(length.ok_or_else(|| error("it ends early".to_owned()))?);
    *input = rest;
    Ok(body)
}

#[allow(deprecated)] // the library has no other way to make one
fn error(reason: String) -> DecodeError {
    DecodeError::new(reason)
}
