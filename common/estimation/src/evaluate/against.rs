//! A deformation against a reference's, as papers compare them at sea: a fixed deviation is removed, the rest is the error.

use frames::{Main, Rot, Sub, Vec3};

/// Errors and ranges about the axes of m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Difference {
    /// `Log` of the turn, in m, that leads from the reference to the solution, rad.
    pub error: Vec3<Main>,
    /// Half width of the solution's 95 % range, rad, if it tells one.
    pub range: Option<[f64; 3]>,
}

/// Figures of many differences. None of them is known of no difference.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Figures {
    /// How many.
    pub count: usize,
    /// Mean error, rad.
    pub mean: [f64; 3],
    /// Root mean square error, rad.
    pub rmse: [f64; 3],
    /// Largest error without its sign, rad.
    pub most: [f64; 3],
    /// Share of errors within the range; `None` if a difference has no range.
    pub coverage: Option<[f64; 3]>,
    /// Root mean square of the range, rad, likewise.
    pub range: Option<[f64; 3]>,
}

impl Figures {
    /// `None` of no difference.
    pub fn of(differences: &[Difference]) -> Option<Self> {
        let count = differences.len();
        if count == 0 {
            return None;
        }
        let errors: Vec<[f64; 3]> = differences.iter().map(|difference| difference.error.array()).collect();
        let ranges: Option<Vec<[f64; 3]>> = differences.iter().map(|difference| difference.range).collect();
        let average = |of: &dyn Fn(usize) -> f64| (0..count).map(of).sum::<f64>() / count as f64;
        let axes = [0, 1, 2];
        Some(Self {
            count,
            mean: axes.map(|i| average(&|k| errors[k][i])),
            rmse: axes.map(|i| average(&|k| errors[k][i].powi(2)).sqrt()),
            most: axes.map(|i| errors.iter().fold(0.0, |most: f64, error| most.max(error[i].abs()))),
            coverage: ranges
                .as_ref()
                .map(|ranges| axes.map(|i| average(&|k| f64::from(u8::from(errors[k][i].abs() <= ranges[k][i]))))),
            range: ranges.as_ref().map(|ranges| axes.map(|i| average(&|k| ranges[k][i].powi(2)).sqrt())),
        })
    }

    /// Root mean square error over the axes, rad.
    pub fn pooled_rmse(&self) -> f64 {
        (self.rmse.iter().map(|rmse| rmse * rmse).sum::<f64>() / 3.0).sqrt()
    }

    /// Share of all errors, about whatever axis, within their range.
    pub fn pooled_coverage(&self) -> Option<f64> {
        self.coverage.map(|coverage| coverage.iter().sum::<f64>() / 3.0)
    }
}

/// The rotation on the shortest way from one to another, at a share of 0 to 1 of it.
pub fn between(from: Rot<Main, Sub>, to: Rot<Main, Sub>, share: f64) -> Rot<Main, Sub> {
    from * Rot::<Sub, Sub>::exp((from.inverse() * to).log() * share)
}

/// `C_s^m` of the solution and `C_r^m` of the reference at one time.
pub type Pair = (Rot<Main, Sub>, Rot<Main, Sub>);

/// The mean rotation of solutions relative to a reference, from pairs (solution, reference): `C_s^m` of a solution is on average
/// `C_r^m` of the reference times it. `None` of no pair.
pub fn fixed(pairs: &[Pair]) -> Option<Rot<Sub, Sub>> {
    let turn = |(solution, reference): &Pair| reference.inverse() * *solution;
    let mut mean = turn(pairs.first()?);
    // each pass leaves an error of the third power of the scatter
    for _ in 0..20 {
        let sum = pairs.iter().fold(Vec3::<Sub>::ZERO, |sum, pair| sum + (mean.inverse() * turn(pair)).log());
        let step = sum * (1.0 / pairs.len() as f64);
        mean = mean * Rot::exp(step);
        if step.norm() < 1e-15 {
            break;
        }
    }
    Some(mean)
}

/// The turn in m that leads from the reference, set off by the fixed rotation, to the solution.
pub fn error(solution: Rot<Main, Sub>, reference: Rot<Main, Sub>, fixed: Rot<Sub, Sub>) -> Vec3<Main> {
    (solution * (reference * fixed).inverse()).log()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn turn<A: frames::Frame, B: frames::Frame>(x: f64, y: f64, z: f64) -> Rot<A, B> {
        Rot::exp(Vec3::new(x, y, z))
    }

    #[test]
    fn a_fixed_deviation_of_any_size_is_found_and_leaves_the_errors() {
        let mounting = turn::<Sub, Sub>(0.3, -2.0, 1.1);
        let wobble = |k: i32| 1e-3 * f64::from(k % 2 * 2 - 1);
        let reference = |k: i32| turn::<Main, Sub>(0.01 * f64::from(k), -0.02, 0.5);
        let solution = |k: i32| turn::<Main, Main>(0.0, 0.0, wobble(k)) * reference(k) * mounting;
        let pairs: Vec<_> = (0..100).map(|k| (solution(k), reference(k))).collect();
        let found = fixed(&pairs).unwrap_or(Rot::identity());
        assert!((found.inverse() * mounting).angle() < 1e-4, "{found:?}");
        let still: Vec<_> = (0..10).map(|k| (reference(k) * mounting, reference(k))).collect();
        let found = fixed(&still).unwrap_or(Rot::identity());
        assert!((found.inverse() * mounting).angle() < 1e-12);
        for k in 0..10 {
            let [x, y, z] = error(solution(k), reference(k), found).array();
            assert!((z - wobble(k)).abs() < 1e-12 && x.abs() < 1e-12 && y.abs() < 1e-12, "{x} {y} {z}");
        }
        assert!(fixed(&[]).is_none());
    }

    #[test]
    fn a_turn_at_a_constant_rate_is_interpolated_exactly() {
        let at = |t: f64| turn::<Main, Sub>(0.2, 0.1, -0.3) * turn::<Sub, Sub>(0.4 * t, -0.2 * t, 0.9 * t);
        for share in [0.0, 0.3, 1.0] {
            assert!((between(at(0.0), at(1.0), share).inverse() * at(share)).angle() < 1e-12);
        }
    }

    #[test]
    fn the_figures_are_those_of_the_differences() {
        let of = |x: f64, z: f64, range| Difference { error: Vec3::new(x, 0.0, z), range };
        let range = Some([1.0, 1.0, 2.0]);
        let figures = Figures::of(&[of(3.0, 2.0, range), of(-1.0, -4.0, range)]);
        let Some(figures) = figures else { panic!("there are two") };
        assert_eq!((figures.mean, figures.most), ([1.0, 0.0, -1.0], [3.0, 0.0, 4.0]));
        assert_eq!(figures.rmse, [5f64.sqrt(), 0.0, 10f64.sqrt()]);
        assert_eq!(figures.coverage, Some([0.5, 1.0, 0.5]));
        assert_eq!(figures.pooled_rmse(), 5f64.sqrt());
        assert_eq!(figures.pooled_coverage().map(|share| (share * 3.0).round()), Some(2.0));
        assert_eq!(Figures::of(&[of(1.0, 1.0, range), of(1.0, 1.0, None)]).map(|f| f.coverage), Some(None));
        assert_eq!(Figures::of(&[]), None);
    }
}
