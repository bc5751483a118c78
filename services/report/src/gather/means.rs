use estimation::evaluate::Spectrum;
use frames::unit;

/// Means are taken so often, Hz, or as often as there are values.
const RATE_HZ: f64 = 20.0;

/// Three components, thinned to means that are held whole for their spectra: 2 MB an hour.
#[derive(Clone, Debug)]
pub struct Means {
    interval_ns: i64,
    together: usize,
    last_ns: Option<i64>,
    sum: [f64; 3],
    count: usize,
    pieces: Vec<[Vec<f64>; 3]>,
}

impl Means {
    /// Of values that come so often.
    pub fn new(interval_ns: i64) -> Self {
        let interval_ns = interval_ns.max(1);
        let together = (1.0 / (RATE_HZ * unit::seconds(interval_ns))).floor().max(1.0) as usize;
        Self { interval_ns, together, last_ns: None, sum: [0.0; 3], count: 0, pieces: Vec::new() }
    }

    /// Takes in the next values; a hole before them begins a new piece.
    pub fn take(&mut self, time_ns: i64, values: [f64; 3]) {
        if values.iter().any(|value| !value.is_finite()) {
            self.last_ns = None;
            return;
        }
        let follows = self.last_ns.is_some_and(|last_ns| {
            let step_ns = time_ns.saturating_sub(last_ns);
            step_ns > 0 && step_ns < self.interval_ns + self.interval_ns / 2
        });
        self.last_ns = Some(time_ns);
        if !follows {
            (self.sum, self.count) = ([0.0; 3], 0);
            self.pieces.push(Default::default());
        }
        self.sum.iter_mut().zip(values).for_each(|(sum, value)| *sum += value);
        self.count += 1;
        if self.count == self.together
            && let Some(piece) = self.pieces.last_mut()
        {
            piece.iter_mut().zip(self.sum).for_each(|(series, sum)| series.push(sum / self.together as f64));
            (self.sum, self.count) = ([0.0; 3], 0);
        }
    }

    /// The spectra of the components; `None` of too little.
    pub fn spectra(&self) -> Option<[Spectrum; 3]> {
        let step_s = self.together as f64 * unit::seconds(self.interval_ns);
        let of = |axis: usize| {
            let pieces: Vec<&[f64]> = self.pieces.iter().map(|piece| piece[axis].as_slice()).collect();
            Spectrum::welch(&pieces, step_s, self.together)
        };
        Some([of(0)?, of(1)?, of(2)?])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    #[test]
    fn the_spectrum_of_the_means_is_that_of_the_values_and_knows_no_hole() {
        let mut means = Means::new(10_000_000);
        for i in (0..30_000i64).filter(|i| !(12_000..12_500).contains(i)) {
            let t = 0.01 * i as f64;
            means.take(i * 10_000_000, [(TAU * 0.5 * t).sin(), 2.0 * (TAU * 4.0 * t).sin(), 7.0]);
        }
        let Some([x, y, z]) = means.spectra() else { panic!("it is long enough") };
        assert!((x.peak_hz() - 0.5).abs() <= x.step_hz && (x.variance() / 0.5 - 1.0).abs() < 0.02);
        assert!((y.peak_hz() - 4.0).abs() <= y.step_hz && (y.variance() / 2.0 - 1.0).abs() < 0.02);
        assert!(z.variance() < 1e-20);
        assert_eq!(means.pieces.len(), 2);
        assert!(Means::new(10_000_000).spectra().is_none());
    }
}
