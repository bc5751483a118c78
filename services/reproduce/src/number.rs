//! Numbers and the paper's words as tables show them.

use experiments::{Bound, Published};

/// Three significant digits; `-` for what is not a number.
pub fn short(value: f64) -> String {
    if !value.is_finite() {
        return "-".into();
    }
    if value == 0.0 {
        return "0".into();
    }
    let magnitude = value.abs().log10().floor() as i32;
    match magnitude {
        -4..=6 => format!("{value:.*}", (2 - magnitude).max(0) as usize),
        _ => format!("{value:.2e}"),
    }
}

/// The bound; why there is none stands below the table.
pub fn bound(bound: &Bound) -> String {
    match bound {
        Bound::Value(value) => short(*value),
        Bound::None(_) => "none".into(),
    }
}

/// What the paper says, in a word if it is nothing.
pub fn brief(paper: &Published) -> String {
    match paper {
        Published::Nothing(_) => "not published".into(),
        other => published(other),
    }
}

/// What the paper says.
pub fn published(paper: &Published) -> String {
    match paper {
        Published::Magnitude(value, _) | Published::Signed(value, _) => value.to_string(),
        Published::Spread(mean, sd) => format!("{mean} ± {sd}"),
        Published::Range(low, high) => format!("{low} to {high}"),
        Published::AtMost(high) => format!("at most {high}"),
        Published::AtLeast(low) => format!("at least {low}"),
        Published::Statement(words, _) => words.clone(),
        Published::Nothing(reason) => format!("not published: {reason}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn three_digits_whatever_the_size() {
        for (value, text) in [
            (0.5942, "0.594"),
            (-12.345, "-12.3"),
            (1234.5, "1234"),
            (0.001234, "0.00123"),
            (1.234e-6, "1.23e-6"),
            (0.0, "0"),
            (f64::NAN, "-"),
            (f64::INFINITY, "-"),
        ] {
            assert_eq!(short(value), text);
        }
    }
}
