//! Power spectral density of a recorded series by Welch's method: tapered stretches that overlap by half, their periodograms averaged.

use realfft::RealFftPlanner;
use std::f64::consts::{PI, TAU};

/// Fewer values than these say nothing of a spectrum.
const LEAST: usize = 64;
/// Longer stretches would leave too few to average.
const LONGEST: usize = 4096;
/// The longest piece holds so many stretches without their overlap.
const STRETCHES: usize = 3;

/// One-sided density at the frequencies of a series.
#[derive(Clone, Debug, PartialEq)]
pub struct Spectrum {
    /// From one frequency to the next, Hz; the first is one such step.
    pub step_hz: f64,
    /// Density, the series' unit squared per Hz.
    pub density: Vec<f64>,
    /// How many stretches it is the mean of.
    pub stretches: usize,
}

/// The mean density of a band.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Band {
    /// Mean of its frequencies, as logarithms, Hz.
    pub frequency_hz: f64,
    /// Mean density.
    pub density: f64,
    /// Its part of the variance.
    pub variance: f64,
}

impl Spectrum {
    /// Of a series in pieces without holes, with `step_s` from value to value, each of them the mean of `mean_of` samples, which dampens what is
    /// fast and is undone here. `None` if no piece is long enough.
    pub fn welch(pieces: &[&[f64]], step_s: f64, mean_of: usize) -> Option<Self> {
        let longest = pieces.iter().map(|piece| piece.len()).max()?;
        let length = 1 << (longest / STRETCHES).clamp(1, LONGEST).ilog2();
        if length < LEAST || step_s.is_nan() || step_s <= 0.0 {
            return None;
        }
        let weights: Vec<f64> = (0..length).map(|j| (PI * (j as f64 + 0.5) / length as f64).sin().powi(2)).collect();
        let squares: f64 = weights.iter().map(|w| w * w).sum();
        let plan = RealFftPlanner::new().plan_fft_forward(length);
        let (mut tapered, mut lines) = (plan.make_input_vec(), plan.make_output_vec());
        let mut density = vec![0.0; length / 2 - 1];
        let mut stretches = 0;
        for piece in pieces {
            for start in (0..=piece.len().saturating_sub(length)).step_by(length / 2) {
                let Some(stretch) = piece.get(start..start + length) else { continue };
                let mean = stretch.iter().sum::<f64>() / length as f64;
                tapered.iter_mut().zip(stretch).zip(&weights).for_each(|((t, y), w)| *t = (y - mean) * w);
                plan.process(&mut tapered, &mut lines).ok()?;
                density.iter_mut().zip(&lines[1..]).for_each(|(sum, line)| *sum += line.norm_sqr());
                stretches += 1;
            }
        }
        let step_hz = 1.0 / (length as f64 * step_s);
        let scale = 2.0 * step_s / squares / f64::from(stretches.max(1));
        for (k, value) in density.iter_mut().enumerate() {
            *value *= scale / damping((k + 1) as f64 * step_hz * step_s, mean_of);
        }
        let sound = stretches > 0 && density.iter().all(|value| value.is_finite());
        sound.then_some(Self { step_hz, density, stretches: stretches as usize })
    }

    /// The variance that it holds.
    pub fn variance(&self) -> f64 {
        self.density.iter().sum::<f64>() * self.step_hz
    }

    /// The frequency of the highest density, Hz.
    pub fn peak_hz(&self) -> f64 {
        let peak = self.density.iter().enumerate().max_by(|a, b| a.1.total_cmp(b.1));
        peak.map_or(0.0, |(k, _)| (k + 1) as f64 * self.step_hz)
    }

    /// Means over bands that are equally wide as logarithms; bands without a frequency are left out.
    pub fn bands(&self, in_a_decade: f64) -> Vec<Band> {
        let mut bands: Vec<(i64, f64, f64, u32)> = Vec::new();
        for (k, density) in self.density.iter().enumerate() {
            let log = ((k + 1) as f64 * self.step_hz).log10();
            let number = (log * in_a_decade).floor() as i64;
            match bands.last_mut().filter(|band| band.0 == number) {
                Some(band) => (band.1, band.2, band.3) = (band.1 + log, band.2 + density, band.3 + 1),
                None => bands.push((number, log, *density, 1)),
            }
        }
        let of = |(_, log, density, count): (i64, f64, f64, u32)| Band {
            frequency_hz: 10f64.powf(log / f64::from(count)),
            density: density / f64::from(count),
            variance: density * self.step_hz,
        };
        bands.into_iter().map(of).collect()
    }
}

/// What the mean of so many samples leaves of the power at a frequency in terms of the means' own.
fn damping(frequency: f64, mean_of: usize) -> f64 {
    let half = TAU * frequency / 2.0;
    let count = mean_of.max(1) as f64;
    (half.sin() / (count * (half / count).sin())).powi(2)
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::SeedableRng;
    use rand_distr::{Distribution, StandardNormal};
    use rand_pcg::Pcg64;

    fn noise(count: usize) -> Vec<f64> {
        let mut random = Pcg64::seed_from_u64(7);
        (0..count).map(|_| StandardNormal.sample(&mut random)).collect()
    }

    #[test]
    fn a_wave_stands_where_it_is_and_holds_its_power() {
        let series: Vec<f64> = (0..6000).map(|i| 5.0 + 3.0 * (TAU * 0.125 * 0.05 * f64::from(i)).sin()).collect();
        let Some(found) = Spectrum::welch(&[&series], 0.05, 1) else { panic!("it is long enough") };
        assert!((found.peak_hz() - 0.125).abs() <= found.step_hz, "{} Hz", found.peak_hz());
        assert!((found.variance() / 4.5 - 1.0).abs() < 0.02, "{}", found.variance());
        let in_bands: f64 = found.bands(10.0).iter().map(|band| band.variance).sum();
        assert!((in_bands / found.variance() - 1.0).abs() < 1e-9);
    }

    #[test]
    fn white_noise_is_level_at_twice_its_variance_times_the_step() {
        let all = noise(40_000);
        let Some(found) = Spectrum::welch(&[&all[..25_000], &all[25_000..]], 0.1, 1) else { panic!("long enough") };
        assert!(found.stretches > 15, "{}", found.stretches);
        for band in found.bands(3.0).iter().filter(|band| band.frequency_hz > 0.05) {
            assert!((band.density / 0.2 - 1.0).abs() < 0.15, "{band:?}");
        }
        assert!((found.variance() - 1.0).abs() < 0.05, "{}", found.variance());
    }

    #[test]
    fn what_a_mean_dampens_is_given_back() {
        let wave = |i: u32| (TAU * 3.0 * 0.01 * f64::from(i)).sin();
        let means: Vec<f64> = (0..4000).map(|k| (10 * k..10 * k + 10).map(wave).sum::<f64>() / 10.0).collect();
        let Some(found) = Spectrum::welch(&[&means], 0.1, 10) else { panic!("it is long enough") };
        assert!((found.variance() / 0.5 - 1.0).abs() < 0.02, "{}", found.variance());
        assert_eq!(damping(0.3, 1), 1.0);
    }

    #[test]
    fn too_little_gives_nothing() {
        let short = noise(3 * LEAST - 1);
        assert_eq!(Spectrum::welch(&[], 0.1, 1), None);
        assert_eq!(Spectrum::welch(&[&short], 0.1, 1), None);
        assert_eq!(Spectrum::welch(&[&noise(1000)], 0.0, 1), None);
        assert_eq!(Spectrum::welch(&[&[f64::NAN; 1000]], 0.1, 1), None);
        assert!(Spectrum::welch(&[&noise(3 * LEAST), &short[..10]], 0.1, 1).is_some());
    }
}
