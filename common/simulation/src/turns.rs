//! Turns of the course.

use crate::Turns;

impl Turns {
    /// Turned so far (rad) and rate of turn (rad/s) at the time `t`; the rate's derivative is continuous.
    pub(crate) fn at(&self, t: f64) -> (f64, f64) {
        let half = self.ramp_s / 2.0;
        let number = ((t + half) / self.every_s).floor();
        if !(number >= 1.0 && self.ramp_s > 0.0) {
            return (0.0, 0.0);
        }
        let since = t - number * self.every_s;
        let (rise, rise_rate) = step((since + half) / self.ramp_s);
        let (fall, fall_rate) = step((since - self.length_s + half) / self.ramp_s);
        let before = (number - 1.0) * self.rate * self.length_s;
        (before + self.rate * self.ramp_s * (rise - fall), self.rate * (rise_rate - fall_rate))
    }
}

/// A smooth step from 0 to 1 over 0 to 1, and its integral first.
fn step(x: f64) -> (f64, f64) {
    let inside = x.clamp(0.0, 1.0);
    (inside.powi(3) * (1.0 - inside / 2.0) + (x - 1.0).max(0.0), inside * inside * (3.0 - 2.0 * inside))
}

#[cfg(test)]
mod tests {
    use super::*;

    const TURNS: Turns = Turns { rate: 0.02, length_s: 180.0, every_s: 1800.0, ramp_s: 10.0 };

    #[test]
    fn the_rate_is_the_derivative_and_both_are_continuous() {
        let h = 1e-3;
        for i in 0..2_200_000 {
            let t = i as f64 * h + 1700.0;
            let ((a, rate), (b, next)) = (TURNS.at(t), TURNS.at(t + h));
            assert!(((b - a) / h - (rate + next) / 2.0).abs() < 1e-9, "{t}");
            // the rate rises at most by 1.5 times its size in a ramp
            assert!((next - rate).abs() <= 1.501 * 0.02 * h / 10.0, "{t}");
        }
    }

    #[test]
    fn a_turn_is_as_long_as_told() {
        for (t, turned, rate) in
            [(-5.0, 0.0, 0.0), (1794.0, 0.0, 0.0), (1890.0, 90.0, 1.0), (1986.0, 180.0, 0.0), (3700.0, 280.0, 1.0)]
        {
            let (angle, w) = TURNS.at(t);
            assert!((angle - turned * 0.02).abs() < 1e-12 && (w - rate * 0.02).abs() < 1e-15, "{t} {angle} {w}");
        }
    }
}
