/// The true sampling instants of a unit, on whole nanoseconds so that a stamp can be exactly true.
#[derive(Clone, Copy)]
pub(crate) struct Sampling {
    phase_ns: f64,
    rate_hz: f64,
}

/// The instant of a unit that never samples.
pub(crate) const NEVER: i64 = i64::MAX;

impl Sampling {
    /// A rate outside 0 to 1 MHz, where instants would coincide, or a phase that is no number makes a unit that never samples.
    pub(crate) fn new(rate_hz: f64, phase_s: f64) -> Self {
        let possible = rate_hz > 0.0 && rate_hz <= 1e6 && phase_s.is_finite();
        let (phase_ns, rate_hz) = if possible { (phase_s * 1e9, rate_hz) } else { (f64::INFINITY, 1.0) };
        Self { phase_ns, rate_hz }
    }

    /// The end of sample `index`; -1 is where the first one begins.
    pub(crate) fn instant(&self, index: i64) -> i64 {
        if self.phase_ns.is_finite() {
            (self.phase_ns + index as f64 * 1e9 / self.rate_hz).round() as i64
        } else {
            NEVER
        }
    }

    /// The last sample that ends by the given time, or -1: a unit starts with the run, or ran before it.
    pub(crate) fn last_by(&self, time_ns: i64) -> i64 {
        (((time_ns as f64 - self.phase_ns) * self.rate_hz / 1e9).floor() as i64).max(-1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn instants_are_exact_after_a_day() {
        let sampling = Sampling::new(200.0, 0.001);
        for index in [-1, 0, 1, 17_280_000, 17_280_001] {
            assert_eq!(sampling.instant(index), 1_000_000 + index * 5_000_000);
        }
        assert_eq!(Sampling::new(3.0, 0.0).instant(2), 666_666_667);
    }

    #[test]
    fn a_unit_that_ran_before_the_start_is_far_on_in_its_numbers() {
        for (phase, last) in [(0.0, -1), (-0.003, -1), (-0.5, 49), (0.007, -1), (20.0, -1), (-1e6, 99_999_999)] {
            let sampling = Sampling::new(100.0, phase);
            assert_eq!(sampling.last_by(-10_000_000), last, "{phase}");
            assert!(sampling.instant(last + 1) > -10_000_000);
        }
    }

    #[test]
    fn impossible_clocks_never_sample() {
        for (rate, phase) in
            [(0.0, 0.0), (-1.0, 0.0), (f64::NAN, 0.0), (1e9, 0.0), (100.0, f64::NAN), (f64::INFINITY, 0.0)]
        {
            assert_eq!(Sampling::new(rate, phase).instant(-1), NEVER);
            assert_eq!(Sampling::new(rate, phase).instant(5), NEVER);
            assert_eq!(Sampling::new(rate, phase).last_by(0), -1);
        }
    }
}
