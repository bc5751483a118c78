//! Figures over trials.

/// The mean; NaN of nothing.
pub fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

/// The root mean square; NaN of nothing.
pub fn rms(values: &[f64]) -> f64 {
    (values.iter().map(|value| value * value).sum::<f64>() / values.len() as f64).sqrt()
}

/// The standard deviation of one trial; NaN of fewer than two.
pub fn spread(values: &[f64]) -> f64 {
    if values.len() < 2 {
        return f64::NAN;
    }
    let mean = mean(values);
    let square: f64 = values.iter().map(|value| (value - mean).powi(2)).sum();
    (square / (values.len() - 1) as f64).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn known_figures() {
        assert_eq!(mean(&[1.0, 2.0, 6.0]), 3.0);
        assert_eq!(rms(&[3.0, 4.0, 0.0, 0.0]), 2.5);
        assert_eq!(spread(&[1.0, 2.0, 6.0]), 7f64.sqrt());
        assert!(spread(&[1.0]).is_nan() && mean(&[]).is_nan());
    }
}
