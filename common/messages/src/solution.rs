use crate::{Flags, Header, message};

/// Deformation and attitude of one area at one instant of the main unit.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Solution {
    /// `sequence` and `time_ns` are the main unit's.
    pub header: Header,
    /// Identity of the parameters in use, 0 for the prior.
    pub params_id: u64,
    /// The pair's epoch, to which `constant` belongs.
    pub epoch: u64,
    /// Total deformation `C_s^m`.
    pub q: [f64; 4],
    /// Its static part `S`, where `C_s^m = Exp(dynamic) S`.
    pub static_q: [f64; 4],
    /// The constant `N` of `A_m C_s^m = N A_s`, relating the frames at the epoch's start.
    pub constant: [f64; 4],
    /// Rotation vector of `q`, rad, in m.
    pub phi: [f64; 3],
    /// `Log(C S^T)`: the total without its static part, rad, in m.
    pub dynamic: [f64; 3],
    /// Rate of the deformation, rad/s, in m.
    pub rate: [f64; 3],
    /// Relative gyro bias that makes `constant` drift, rad/s, in m.
    pub drift: [f64; 3],
    /// Relative scale and non-orthogonality of the gyros, a symmetric matrix in m: xx, yy, zz, xy, xz, yz. Its product with the
    /// main unit's rate adds to `drift`.
    pub scale: [f64; 6],
    /// Covariance of the error of `q`, rad^2, in m.
    pub covariance: [f64; 9],
    /// Covariance of the error of `static_q`, rad^2, in m.
    pub static_covariance: [f64; 9],
    /// Covariance of the error of `dynamic`, rad^2, in m.
    pub dynamic_covariance: [f64; 9],
    /// The installation as the motion alone shows it, averaged over the run; all zeros while it does not.
    pub registered: [f64; 4],
    /// Standard deviation of its error, rad, in m.
    pub registered_sigma: [f64; 3],
    /// By how much the sub unit's stamps are late, s.
    pub delay: f64,
    /// Standard deviation of the error of `delay`, s; 0 where no delay is estimated.
    pub delay_sigma: f64,
    /// By how much the delay grows in a second.
    pub skew: f64,
    /// Standard deviation of the error of `skew`; 0 where it is not estimated.
    pub skew_sigma: f64,
    /// Half width of the published 95 % range of each component of `q`'s error, rad.
    pub range: [f64; 3],
    /// `C_s^n`; all zeros where the main unit's attitude is not known.
    pub deck: [f64; 4],
    /// Standard deviation of the error of `deck` about east, north, up, rad.
    pub deck_sigma: [f64; 3],
    /// Mean of the filter's squared innovations in terms of their variance over the last minute: 1 is expected, less says that the filter is
    /// cautious; 0 where it is not told.
    pub nis: f64,
    /// Rotation vector of the zero in force: `q` and `deck` are `C Exp(zero)^T` of what was estimated, and so is the static part; rad.
    pub zero: [f64; 3],
    /// Index of the area.
    pub area: u32,
    /// 1 when the deformation may be used.
    pub valid: u32,
    /// Why it is what it is.
    pub flags: Flags,
    /// Keeps the size a multiple of 8 without hidden bytes.
    pub reserved: u32,
}

message!(Solution, "deckflex/Solution/3");

impl Solution {
    /// Whether the deformation may be used.
    pub fn is_valid(&self) -> bool {
        self.valid != 0
    }
}
