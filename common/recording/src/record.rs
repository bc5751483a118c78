//! What a recording holds, and the numbers of its fields.

use crate::Adoption;
use crate::structure::{PACKAGE, Structure, merge_all, schema, structure};
use messages::{FlexureParams, Header, Health, ImuPair, ImuSample, MainAttitude, Solution, Stamps, StatePart, Truth};
use prost::DecodeError;

// Of a header `end` is left out, since the marks that end a stream are not recorded, and the fields without meaning are too.
structure!(Stamps { 1 due_ns, 2 source_ns, 3 complete_ns, 4 pair_ns, 5 solution_ns, 6 parameters_ns });
structure!(Header { 1 run_id, 2 sequence, 3 time_ns, 4 clock_domain, 5 stamps } left out { end });
structure!(ImuSample { 1 header, 2 interval_ns, 3 ordinal, 4 dtheta, 5 dvel, 6 flags, 7 unit });
structure!(MainAttitude { 1 header, 2 q, 3 sigma });
structure!(ImuPair {
    1 header, 2 epoch, 3 interval_ns, 4 dtheta_m, 5 dvel_m, 6 dtheta_s, 7 dvel_s, 8 attitude_m, 9 attitude_s, 10 ins, 11 ins_sigma,
    12 disturbance, 13 area, 14 flags
});
structure!(FlexureParams {
    1 header, 2 id, 3 window_begin_ns, 4 effective_from_ns, 5 mu, 6 b, 7 sigma, 8 ln_mu_sd, 9 ln_b_sd, 10 ln_sigma_sd, 11 points,
    12 area, 13 second_mu, 14 second_b, 15 second_sigma
});
structure!(Adoption { 1 header, 2 params_id, 3 area, 4 late });
structure!(Solution {
    1 header, 2 params_id, 3 epoch, 4 q, 5 static_q, 6 constant, 7 phi, 8 dynamic, 9 rate, 10 drift, 11 scale, 12 covariance,
    13 static_covariance, 14 dynamic_covariance, 15 registered, 16 registered_sigma, 17 delay, 18 delay_sigma, 19 skew,
    20 skew_sigma, 21 range, 22 deck, 23 deck_sigma, 24 area, 25 valid, 26 flags,
    27 nis, 28 zero
} left out { reserved });
structure!(StatePart { 1 header, 2 length, 3 offset, 4 area, 5 bytes } left out { reserved });
structure!(Truth { 1 header, 2 q, 3 static_q, 4 dynamic, 5 ship, 6 area } left out { reserved });
structure!(Health {
    1 header, 2 taken, 3 given, 4 lost, 5 missing, 6 refused, 7 suspect, 8 overflow, 9 late, 10 restarted_windows, 11 stage,
    12 area, 13 state, 14 scheduling, 15 pid, 16 alarms
});

macro_rules! records {
    ($($(#[$doc:meta])* $variant:ident($type:ident)),* $(,)?) => {
        /// A message of a recording.
        // no allocation where messages are handed from thread to thread
        #[allow(clippy::large_enum_variant)]
        #[derive(Clone, Copy, Debug, PartialEq)]
        pub enum Record { $($(#[$doc])* $variant($type)),* }

        impl Record {
            /// The name of its schema.
            pub fn schema_name(&self) -> String {
                match self { $(Self::$variant(_) => name_of::<$type>()),* }
            }

            /// Its schema, a serialised set of Protocol Buffers' file descriptors.
            pub fn schema(&self) -> Vec<u8> {
                match self { $(Self::$variant(_) => schema::<$type>()),* }
            }

            /// Its bytes.
            pub fn encode(&self) -> Vec<u8> {
                let mut out = Vec::with_capacity(1024);
                match self { $(Self::$variant(message) => message.encode(&mut out)),* }
                out
            }

            /// The names of its columns in a table, with the units of the message's fields.
            pub fn columns(&self) -> Vec<String> {
                match self { $(Self::$variant(_) => <$type as Structure>::columns()),* }
            }

            /// Its values in these columns, as short as they can be read back exactly.
            pub fn values(&self) -> Vec<String> {
                let mut values = Vec::new();
                match self { $(Self::$variant(message) => Structure::values(message, &mut values)),* }
                values
            }

            /// The message of these bytes; `None` if the schema is not one of ours.
            ///
            /// # Errors
            /// The bytes are not of that schema.
            pub fn decode(schema_name: &str, bytes: &[u8]) -> Result<Option<Self>, DecodeError> {
                $(if schema_name == name_of::<$type>() {
                    let mut message = $type::default();
                    merge_all(&mut message, bytes)?;
                    return Ok(Some(Self::$variant(message)));
                })*
                Ok(None)
            }

            /// The header.
            pub fn header(&self) -> &Header {
                match self { $(Self::$variant(message) => &message.header),* }
            }
        }

        $(impl From<$type> for Record {
            fn from(message: $type) -> Self {
                Self::$variant(message)
            }
        })*
    };
}

fn name_of<S: Structure>() -> String {
    format!("{PACKAGE}.{}", S::NAME)
}

records! {
    /// A sample of a unit.
    Sample(ImuSample),
    /// The main unit's attitude.
    Attitude(MainAttitude),
    /// Both units' motion at one instant.
    Pair(ImuPair),
    /// A parameter set, when it was learnt.
    Parameters(FlexureParams),
    /// A parameter set that took effect.
    Adoption(Adoption),
    /// A solution.
    Solution(Solution),
    /// A part of an estimator's state.
    State(StatePart),
    /// The truth of a simulation.
    Truth(Truth),
    /// How a stage does.
    Health(Health),
}

impl Record {
    /// When a stage published it, ns of the monotonic clock; `None` where that is not told.
    pub fn published_ns(&self) -> Option<i64> {
        let stamps = self.header().stamps;
        let ns = match self {
            Self::Sample(_) | Self::Attitude(_) | Self::Truth(_) => stamps.source_ns,
            Self::Pair(_) => stamps.pair_ns,
            Self::Solution(_) | Self::Adoption(_) | Self::State(_) => stamps.solution_ns,
            Self::Parameters(_) => stamps.parameters_ns,
            Self::Health(_) => 0,
        };
        (ns != 0).then_some(ns)
    }
}
