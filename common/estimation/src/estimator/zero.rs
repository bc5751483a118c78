//! A zero: the sub unit's axes are told as turned, so that the deformation at which it was taken is told as none.
//!
//! `C' = C Exp(zero)^T`. The turn stands at the sub unit's side, where a badly known mounting would: the dynamic part, rates, covariances
//! and ranges, which are seen in the main unit's axes, do not change by a bit.

use crate::{Estimator, Frozen, StateError};
use frames::{Main, Nav, Rot, Sub, Vec3};
use messages::{Flags, FlexureParams, ImuPair, Solution};

/// An estimator whose solutions are told from a zero.
pub struct Zeroed {
    inner: Box<dyn Estimator>,
    zero: Vec3<Sub>,
}

impl Zeroed {
    /// The zero's rotation vector, rad, is the same in m and in s.
    pub fn new(inner: Box<dyn Estimator>, zero: Vec3<Main>) -> Self {
        Self { inner, zero: zero.array().into() }
    }
}

impl Estimator for Zeroed {
    fn offer(&mut self, params: FlexureParams) {
        self.inner.offer(params);
    }

    fn step(&mut self, pair: &ImuPair) -> Solution {
        let mut solution = self.inner.step(pair);
        apply(&mut solution, self.zero);
        solution
    }

    /// What was told is from the zero; what is gone on from is not.
    fn resume(&mut self, last: &Solution) {
        let estimated = Rot::<Main, Sub>::from_wxyz(last.static_q) * Rot::<Sub, Sub>::exp(self.zero);
        self.inner.resume(&Solution { static_q: estimated.quaternion(), ..*last });
    }

    /// The zero acts on what is told and not on what is estimated.
    fn freeze(&self) -> Option<Frozen> {
        self.inner.freeze()
    }

    fn thaw(&mut self, state: &[u8]) -> Result<(), StateError> {
        self.inner.thaw(state)
    }
}

fn apply(solution: &mut Solution, zero: Vec3<Sub>) {
    solution.zero = zero.array();
    solution.flags |= Flags::ZEROED;
    if solution.q == [0.0; 4] {
        return;
    }
    let turn = Rot::<Sub, Sub>::exp(-zero);
    let total = Rot::<Main, Sub>::from_wxyz(solution.q) * turn;
    solution.q = total.quaternion();
    solution.phi = total.log_beside(solution.phi.into()).array();
    solution.static_q = (Rot::<Main, Sub>::from_wxyz(solution.static_q) * turn).quaternion();
    if solution.deck != [0.0; 4] {
        solution.deck = (Rot::<Nav, Sub>::from_wxyz(solution.deck) * turn).quaternion();
    }
}

/// The static part as it was estimated; `None` if it is not finite.
pub(crate) fn static_part(solution: &Solution) -> Option<Rot<Main, Sub>> {
    let told = Rot::<Main, Sub>::from_quaternion(solution.static_q)?;
    match solution.flags.contains(Flags::ZEROED) {
        true => Some(told * Rot::<Sub, Sub>::exp(solution.zero.into())),
        false => Some(told),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use frames::unit::DEGREE;

    fn solution(phi: Vec3<Main>) -> Solution {
        let q = Rot::<Main, Sub>::exp(phi);
        let ship = Rot::<Nav, Main>::exp(Vec3::new(0.1, -0.2, 2.0));
        Solution {
            q: q.quaternion(),
            static_q: Rot::<Main, Sub>::exp(phi * 0.9).quaternion(),
            phi: phi.array(),
            dynamic: [1e-3, 2e-3, -3e-3],
            rate: [1e-4; 3],
            covariance: [1e-8; 9],
            range: [1e-4, 2e-4, 3e-4],
            deck: (ship * q).quaternion(),
            deck_sigma: [1e-3; 3],
            valid: 1,
            flags: Flags::PRIOR,
            ..Solution::default()
        }
    }

    #[test]
    fn the_deformation_of_the_zero_is_told_as_none_and_the_deck_lies_as_the_ship() {
        let zero = Vec3::new(1.5, -2.0, 3.0) * DEGREE;
        let mut zeroed = solution(zero);
        apply(&mut zeroed, zero.array().into());
        assert!(Vec3::<Main>::from(zeroed.phi).norm() < 1e-15, "{:?}", zeroed.phi);
        let ship = Rot::<Nav, Main>::exp(Vec3::new(0.1, -0.2, 2.0));
        assert!((Rot::<Nav, Main>::from_wxyz(zeroed.deck) * ship.inverse()).angle() < 1e-15);
        assert_eq!(zeroed.flags, Flags::PRIOR | Flags::ZEROED);
        assert_eq!(zeroed.zero, zero.array());
    }

    #[test]
    fn what_is_seen_in_the_main_units_axes_stays_as_it_is() {
        let zero = Vec3::new(0.01, 0.02, 0.03);
        let before = solution(Vec3::new(0.02, 0.01, -0.03));
        let mut after = before;
        apply(&mut after, zero);
        assert_eq!(after.range, before.range);
        assert_eq!((after.dynamic, after.rate, after.valid), (before.dynamic, before.rate, before.valid));
        assert_eq!((after.covariance, after.deck_sigma), (before.covariance, before.deck_sigma));
        // a small zero takes its own rotation vector off, to second order
        let phi = Vec3::<Main>::from(before.phi);
        let off = phi - Vec3::from(zero.array()) - Vec3::from(after.phi);
        assert!(off.norm() < phi.norm() * zero.norm(), "{}", off.norm());
        let estimated = static_part(&after).map(|found| found * Rot::<Main, Sub>::from_wxyz(before.static_q).inverse());
        assert!(estimated.is_some_and(|turn| turn.angle() < 1e-15));
    }

    #[test]
    fn the_angle_keeps_its_branch_near_a_half_turn() {
        let mut zeroed = solution(Vec3::new(0.0, 0.0, 179.0) * DEGREE);
        apply(&mut zeroed, Vec3::new(0.0, 0.0, -3.0) * DEGREE);
        assert!((zeroed.phi[2] - 182.0 * DEGREE).abs() < 1e-9, "{}", zeroed.phi[2] / DEGREE);
    }

    #[test]
    fn without_an_estimate_nothing_is_turned() {
        let mut none = Solution::default();
        apply(&mut none, Vec3::new(0.01, 0.0, 0.0));
        assert_eq!((none.q, none.static_q, none.deck), ([0.0; 4], [0.0; 4], [0.0; 4]));
        assert_eq!(none.flags, Flags::ZEROED);
    }
}
