//! What a filter may safely use.
//!
//! A filter that trusts too stiff a model (b too large, sigma or the density Q too small) is confidently wrong; one with too
//! wide a sigma at the same Q loses nothing that can be measured. So a model near critical damping gets twice its sigma at the
//! same Q, `b' = mu' = (Q / 4 sigma'^2)^(1/3)`; one that oscillates keeps b and mu and gets 1.15 sigma. Where the parameters are renewed
//! all the time and the window holds nothing else, a long one's oscillation is taken at its figure: with 1.15 the estimator of paper 003's
//! ship claimed 54, 47 and 38 arcsec where it was 45, 39 and 33 off and one told the truth claimed 47, 41 and 34; at its figure 48, 42
//! and 34. Where part of the flexure follows the waves it needs the margin: without it 1.96 deviations held .924 of the dynamic part's
//! errors about x, not .946.
//!
//! A window of up to [`SHORT_S`] does not show a flexure whose time is that long: measured on one of 1/e time 30 s, windows of
//! 20 to 120 s give b three to six times too large, while Q is right to 15 to 30 % from 60 s on. So a short window's b is held
//! below [`SLOW`], its Q (sigma, where it oscillates) is raised by one standard deviation, and an oscillation is believed only from
//! [`BELIEVABLE_S`] on and if it shows by three standard deviations of `ln mu`. One that is not believed still raises Q, so that the
//! broad model's density at the frequency in question is no less. With two standard deviations and no least length one seed in
//! sixteen of paper 000's scenario took noise for an oscillation of 0.15 arcmin at 23 s and was 46 arcmin wrong at 1.5 arcmin sigma.

use super::axis::Identified;
use super::series::Series;
use super::whittle;
use crate::flexure::Flexure;

/// Windows up to this length are short, s.
pub const SHORT_S: f64 = 120.0;
/// Largest natural frequency of a short window near critical damping, rad/s.
pub const SLOW: f64 = 0.08;
/// Windows shorter than this are too short to believe an oscillation, s.
pub const BELIEVABLE_S: f64 = 60.0;
/// By how many standard deviations of `ln mu` a short window must show an oscillation.
const BELIEF: f64 = 3.0;
/// The most by which an oscillation that is not believed raises Q.
const LARGEST_RAISE: f64 = 30.0;
/// A standard deviation of a logarithm beyond this says that nothing is known; it is not believed as a factor.
const LARGEST_DOUBT: f64 = 2.0;
/// The largest `mu / b` of a model that oscillates.
const OSCILLATES: f64 = 0.5;
/// By how much the sigma of an oscillation is raised at least.
const WIDER: f64 = 1.15;

/// By how many standard deviations the size of an oscillation that is believed in a short window is raised. With one, one start in twelve of paper 002 was
/// 5.1 deviations off; with two 3.9, as with the true parameters, and the first minutes lose 0.8 % of accuracy.
const SIZE_DOUBT: f64 = 2.0;

/// Twice the logarithm of a likelihood ratio that leaves no doubt. Windows of 30 to 90 s of a flexure of 1/e time 10 to 30 s came to 9 at most (60 of
/// them), windows of 40 s of one that oscillates at 0.18 Hz to 11 to 70.
const DECISIVE: f64 = 16.0;

/// Whether a short window, too, shows that the flexure is not a slow one: then its parameters may be believed where a filter runs over the data again when
/// better ones come. The deviations of the parameters do not say so: in a window that ends before the flexure's own time they are far too small.
pub fn is_not_slow(series: &Series) -> bool {
    whittle::against_slow(series, SLOW).is_some_and(|evidence| evidence > DECISIVE)
}

/// How far a window is believed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Belief {
    /// With every margin: what a filter is told must do until the end of the run.
    Guarded,
    /// The filter runs over its data again when better parameters come, and a short window [`is_not_slow`].
    Decided,
    /// The same, and a long window holds nothing but what has been identified: it is taken at its figure.
    Described,
}

/// The parameters that a filter gets from a window of `length_s`. A short window that is [`Belief::Decided`] keeps its frequency and is still made larger by
/// what is not known of its size.
pub fn safe(identified: &Identified, length_s: f64, belief: Belief) -> Flexure {
    let Flexure { mu, b, sigma } = identified.flexure;
    let density = identified.flexure.density();
    let short = length_s <= SHORT_S;
    let decided = belief == Belief::Decided;
    let doubt = |sd: f64| if short { sd.min(LARGEST_DOUBT).exp() } else { 1.0 };
    let oscillates = if decided {
        mu / b <= OSCILLATES
    } else {
        mu / b * doubt(BELIEF * identified.ln_mu_sd) <= OSCILLATES && length_s >= BELIEVABLE_S
    };
    if oscillates {
        let wider = if belief == Belief::Described && !short {
            // the mean of sigma squared, which is what the variance of a static angle goes by
            identified.ln_sigma_sd.powi(2).exp()
        } else {
            let deviations = if decided { SIZE_DOUBT } else { 1.0 };
            doubt(deviations * identified.ln_sigma_sd).max(WIDER)
        };
        return Flexure { mu, b, sigma: sigma * wider };
    }
    // No less than what an oscillation of the same size would get, so that doubt about the damping never takes density away.
    let raise = (b / (2.0 * mu)).powi(2).clamp(1.0, LARGEST_RAISE) * doubt(identified.ln_density_sd).max(WIDER * WIDER);
    let density = if short { density * raise } else { density };
    let doubled = (density / (16.0 * sigma * sigma)).cbrt();
    let b = if short && !decided { doubled.min(SLOW) } else { doubled };
    Flexure { mu: b, b, sigma: (density / (4.0 * b * b * b)).sqrt() }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn identified(mu: f64, b: f64) -> Identified {
        let flexure = Flexure { mu, b, sigma: 1e-3 };
        Identified { flexure, ln_mu_sd: 0.2, ln_b_sd: 0.2, ln_sigma_sd: 0.3, ln_density_sd: 0.1 }
    }

    #[test]
    fn near_critical_damping_sigma_doubles_at_the_same_density() {
        for (mu, b) in [(0.2, 0.2), (0.6, 0.3), (0.11, 0.2)] {
            let before = identified(mu, b);
            let after = safe(&before, 300.0, Belief::Guarded);
            assert!((after.sigma / before.flexure.sigma - 2.0).abs() < 1e-12);
            assert!((after.density() / before.flexure.density() - 1.0).abs() < 1e-12);
            assert_eq!(after.mu, after.b);
        }
    }

    #[test]
    fn an_oscillation_keeps_its_frequency() {
        let (before, after) = (identified(0.1, 0.6), safe(&identified(0.1, 0.6), 300.0, Belief::Guarded));
        assert_eq!((after.mu, after.b), (before.flexure.mu, before.flexure.b));
        assert!((after.sigma / before.flexure.sigma - 1.15).abs() < 1e-12);
    }

    #[test]
    fn a_long_window_that_the_model_describes_is_taken_at_its_figure() {
        let before = identified(0.1, 0.6);
        let after = safe(&before, 300.0, Belief::Described);
        assert_eq!((after.mu, after.b), (before.flexure.mu, before.flexure.b));
        assert!((after.sigma / before.flexure.sigma - 0.09_f64.exp()).abs() < 1e-12);
        for short in [60.0, SHORT_S] {
            assert_eq!(safe(&before, short, Belief::Described), safe(&before, short, Belief::Guarded));
        }
    }

    #[test]
    fn a_short_window_is_never_stiffer_or_quieter_than_a_long_one() {
        for (mu, b) in [(0.2, 0.2), (0.6, 0.3), (0.22, 0.5), (0.1, 0.6), (2.0, 5.0)] {
            let (short, long) =
                (safe(&identified(mu, b), 60.0, Belief::Guarded), safe(&identified(mu, b), 300.0, Belief::Guarded));
            assert!(
                short.sigma > long.sigma && short.b <= long.b && short.density() > 0.999_999 * long.density(),
                "{mu} {b}"
            );
        }
    }
}
