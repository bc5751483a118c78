//! How the sea grows or calms down.

use crate::SeaChange;

impl SeaChange {
    /// Angle (rad) and rate (rad/s) at the time `t` of a swing that would have these without the change.
    pub(crate) fn apply(&self, t: f64, (angle, rate): (f64, f64)) -> (f64, f64) {
        let (factor, growth) = self.at(t);
        (factor * angle, factor * rate + growth * angle)
    }

    /// How many times as large the swing is at the time `t`, and how fast that grows, 1/s.
    fn at(&self, t: f64) -> (f64, f64) {
        let whole = self.factor - 1.0;
        let u = (t - self.at_s) / self.ramp_s;
        if u > 0.0 && u < 1.0 {
            let share = u.powi(3) * (10.0 - 15.0 * u + 6.0 * u * u);
            (1.0 + whole * share, whole * 30.0 * (u * (1.0 - u)).powi(2) / self.ramp_s)
        } else {
            (if t > self.at_s { self.factor } else { 1.0 }, 0.0)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The factor's first and second derivative are bounded by 15/8 and 5.78 over the ramp, as the polynomial's are.
    #[test]
    fn the_growth_is_the_derivative_and_both_are_continuous() {
        let h = 1e-3;
        for (factor, ramp_s) in [(2.0, 60.0), (0.25, 10.0)] {
            let change = SeaChange { at_s: 100.0, factor, ramp_s };
            for i in 0..90_000 {
                let t = 90.0 + i as f64 * h;
                let ((a, growth), (b, next)) = (change.at(t), change.at(t + h));
                let whole = (factor - 1.0f64).abs();
                assert!(((b - a) / h - (growth + next) / 2.0).abs() < 1e-6 * whole, "{t}");
                assert!(
                    growth.abs() <= 1.876 * whole / ramp_s
                        && (next - growth).abs() <= 5.78 * whole * h / ramp_s.powi(2)
                );
            }
            assert_eq!((change.at(100.0), change.at(100.0 + ramp_s)), ((1.0, 0.0), (factor, 0.0)));
            assert!((change.at(100.0 + ramp_s / 2.0).0 - (1.0 + factor) / 2.0).abs() < 1e-12);
        }
    }

    #[test]
    fn without_a_ramp_the_change_comes_at_once() {
        for ramp_s in [0.0, -1.0, f64::NAN] {
            let change = SeaChange { at_s: 5.0, factor: 3.0, ramp_s };
            assert_eq!([5.0, 5.001].map(|t| change.apply(t, (0.1, 0.2))), [(0.1, 0.2), (3.0 * 0.1, 3.0 * 0.2)]);
        }
    }
}
