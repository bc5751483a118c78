//! The state of an estimator as bytes: what an estimator of the same settings goes on from as if it had seen everything itself.
//!
//! The bytes hold the program's version, a fingerprint of the settings and the state, as MessagePack: floating-point numbers keep all their bits, NaN and
//! infinities included, and the types of all values stand in the bytes.

use rmp_serde::{Deserializer, Serializer};
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use std::fmt::{self, Write};

/// The program and the layout of its states; whoever changes what an estimator does with the same state changes the number.
const FORMAT: &str = concat!("deckflex ", env!("CARGO_PKG_VERSION"), ", states 2");

/// A copy of a state, which gives its bytes wherever there is time for it.
pub type Frozen = Box<dyn FnOnce() -> Vec<u8> + Send>;

/// Why an estimator cannot go on from a state.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum StateError {
    /// Another version of the program wrote it.
    #[error("it was written by {found}, and this is {FORMAT}")]
    Version {
        /// What the state says of its writer.
        found: String,
    },
    /// The estimator had other settings.
    #[error("it is that of an estimator with another configuration")]
    Settings,
    /// The bytes are not those of such a state.
    #[error("it cannot be read: {0}")]
    Damaged(String),
}

/// The number by which settings are known again (FNV-1a of how they are written out).
pub(crate) fn fingerprint(settings: &impl fmt::Debug) -> u64 {
    struct Hash(u64);
    impl Write for Hash {
        fn write_str(&mut self, text: &str) -> fmt::Result {
            self.0 = text.bytes().fold(self.0, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x100_0000_01b3));
            Ok(())
        }
    }
    let mut hash = Hash(0xcbf2_9ce4_8422_2325);
    // the hash itself refuses nothing
    let _ = write!(hash, "{settings:?}");
    hash.0
}

/// The bytes of a state.
pub(crate) fn seal(settings: u64, state: &impl Serialize) -> Vec<u8> {
    let mut out = Vec::new();
    let mut serializer = Serializer::new(&mut out);
    let written = FORMAT.serialize(&mut serializer);
    let written = written.and_then(|()| settings.serialize(&mut serializer));
    written
        .and_then(|()| state.serialize(&mut serializer))
        .expect("memory takes lists of numbers whose lengths are known");
    out
}

/// The state that the bytes are of.
pub(crate) fn open<T: Serialize + DeserializeOwned>(settings: u64, bytes: &[u8]) -> Result<T, StateError> {
    let damaged = |error: rmp_serde::decode::Error| StateError::Damaged(error.to_string());
    let mut deserializer = Deserializer::new(bytes);
    let found = String::deserialize(&mut deserializer).map_err(damaged)?;
    if found != FORMAT {
        return Err(StateError::Version { found });
    }
    if u64::deserialize(&mut deserializer).map_err(damaged)? != settings {
        return Err(StateError::Settings);
    }
    let state = T::deserialize(&mut deserializer).map_err(damaged)?;
    // no layout but its own gives the same bytes
    if seal(settings, &state) != bytes {
        return Err(StateError::Damaged("its layout is another one".to_owned()));
    }
    Ok(state)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_bit_of_a_number_comes_back() {
        let odd = f64::from_bits(0x7ff8_0000_dead_beef);
        let state = vec![odd, f64::INFINITY, -0.0, 5e-324, 0.1 + 0.2, f64::MIN];
        let again: Vec<f64> = open(7, &seal(7, &state)).expect("readable");
        assert!(state.iter().zip(&again).all(|(a, b)| a.to_bits() == b.to_bits()) && state.len() == again.len());
        let numbers = (i64::MIN, u64::MAX, Some(3_u32), None::<u32>);
        assert_eq!(open::<(i64, u64, Option<u32>, Option<u32>)>(7, &seal(7, &numbers)), Ok(numbers));
    }

    #[test]
    fn what_is_of_something_else_is_refused() {
        let bytes = seal(7, &(1.0, 2_u8));
        assert_eq!(open::<(f64, u8)>(8, &bytes), Err(StateError::Settings));
        let other = [&bytes[..10], b"9", &bytes[11..]].concat();
        assert!(matches!(open::<(f64, u8)>(7, &other), Err(StateError::Version { found }) if found != FORMAT));
        for layout in [open::<(f64, f64)>(7, &bytes).is_err(), open::<(f64,)>(7, &bytes).is_err()] {
            assert!(layout);
        }
        for cut in 0..bytes.len() {
            assert!(open::<(f64, u8)>(7, &bytes[..cut]).is_err(), "{cut}");
        }
        assert!(open::<(f64, u8)>(7, &[&bytes[..], b"x"].concat()).is_err());
    }

    #[test]
    fn a_fingerprint_tells_settings_apart() {
        assert_eq!(fingerprint(&("so3", 0.1)), fingerprint(&("so3", 0.1)));
        assert_ne!(fingerprint(&("so3", 0.1)), fingerprint(&("so3", 0.1 + 1e-17 + 1e-16)));
    }
}
