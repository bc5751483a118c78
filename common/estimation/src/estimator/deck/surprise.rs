//! Whether the data agree with the filter: the normalised innovations squared over the last minute.

/// How far back the mean reaches, s.
const MEMORY_S: f64 = 60.0;
/// A mean beyond this says that the covariance is too small: a filter with the right model has 1, with a cautious one less.
const LARGEST: f64 = 3.0;

/// Mean of the squared innovations in terms of their variance.
#[derive(Clone, Copy, Debug)]
pub struct Surprise {
    mean: f64,
    weight: f64,
}

impl Surprise {
    /// Of a filter that corrects so often, s.
    pub fn new(period_s: f64) -> Self {
        Self { mean: 1.0, weight: (period_s / MEMORY_S).clamp(0.0, 1.0) }
    }

    /// Takes the mean over the values of one correction.
    pub fn take(&mut self, square: f64) {
        self.mean += (square - self.mean) * self.weight;
    }

    /// The mean over the last minute.
    pub fn mean(&self) -> f64 {
        self.mean
    }

    /// By how much the covariance is too small; 1 where nothing says so.
    pub fn excess(&self) -> f64 {
        if self.mean > LARGEST { self.mean } else { 1.0 }
    }

    /// Whether the covariance can be believed.
    pub fn is_small(&self) -> bool {
        self.mean <= LARGEST
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_outlier_is_borne_and_a_wrong_model_is_not() {
        let mut surprise = Surprise::new(0.1);
        surprise.take(900.0);
        assert!(surprise.is_small() && surprise.excess() == 1.0);
        (0..300).for_each(|_| surprise.take(9.0));
        assert!(!surprise.is_small() && surprise.excess() > 3.0);
        (0..3000).for_each(|_| surprise.take(0.8));
        assert!(surprise.is_small());
    }
}
