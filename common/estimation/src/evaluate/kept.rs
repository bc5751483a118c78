use super::{Coherence, Deviations, ErrorRange, Evaluate, Observed};
use serde::{Deserialize, Serialize};

/// A range with all that it has seen.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub enum Kept {
    /// So many standard deviations.
    Deviations(Deviations),
    /// By the covariance of flexure rate and static part.
    ErrorRange(ErrorRange),
    /// By an assumed coherence.
    Coherence(Coherence),
    /// By the coherence that the data show.
    Observed(Observed),
}

impl Kept {
    /// The range, which goes on from there.
    pub fn evaluate(self) -> Box<dyn Evaluate> {
        match self {
            Self::Deviations(range) => Box::new(range),
            Self::ErrorRange(range) => Box::new(range),
            Self::Coherence(range) => Box::new(range),
            Self::Observed(range) => Box::new(range),
        }
    }

    /// Whether two differ in nothing but what they have seen.
    pub fn is_like(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Deviations(own), Self::Deviations(other)) => own.0 == other.0,
            (Self::ErrorRange(own), Self::ErrorRange(other)) => own.factor() == other.factor(),
            (Self::Coherence(own), Self::Coherence(other)) => own.factor() == other.factor(),
            (Self::Observed(_), Self::Observed(_)) => true,
            _ => false,
        }
    }
}
