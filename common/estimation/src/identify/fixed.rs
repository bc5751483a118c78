use crate::Identifier;
use messages::{FlexureParams, ImuPair, Solution};

/// Never identifies anything: the estimator keeps the parameters of its configuration.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Fixed;

impl Identifier for Fixed {
    fn step(&mut self, _pair: &ImuPair, _solution: &Solution) -> Option<FlexureParams> {
        None
    }

    fn restarted_windows(&self) -> u64 {
        0
    }
}
