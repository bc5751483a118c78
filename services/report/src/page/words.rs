//! Numbers and times as they are read.

use crate::plot::Axis;
use frames::unit;
use std::time::{Duration, UNIX_EPOCH};

/// With so many decimals and a minus that is one.
pub fn number(value: f64, decimals: usize) -> String {
    if value.is_finite() { crate::plot::signed(format!("{value:.decimals$}")) } else { NOTHING.to_owned() }
}

/// What stands where nothing is known.
pub const NOTHING: &str = "–";

/// A number that may not be known.
pub fn known(value: Option<f64>, decimals: usize) -> String {
    value.map_or(NOTHING.to_owned(), |value| number(value, decimals))
}

/// With about three digits, whatever its size.
pub fn digits(value: f64) -> String {
    if !value.is_finite() {
        return NOTHING.to_owned();
    }
    let decimals = (2.0 - value.abs().max(1e-9).log10().floor()).clamp(0.0, 6.0) as usize;
    if value != 0.0 && !(1e-4..1e7).contains(&value.abs()) {
        return crate::plot::signed(format!("{value:.2e}"));
    }
    number(value, decimals)
}

/// A number that was told, as it was told.
pub fn plain(value: f64) -> String {
    crate::plot::signed(format!("{}", (value * 1e6).round() / 1e6))
}

/// A whole number in groups of three.
pub fn count(count: u64) -> String {
    let digits = count.to_string();
    let groups: Vec<&str> = digits.as_bytes().rchunks(3).rev().filter_map(|group| str::from_utf8(group).ok()).collect();
    groups.join("\u{202f}")
}

/// A share in percent.
pub fn percent(share: f64) -> String {
    let decimals = if (0.0005..=0.9995).contains(&share) { 1 } else { 2 };
    let text = format!("{:.decimals$}", 100.0 * share);
    let text = if share == 1.0 || share == 0.0 { format!("{:.0}", 100.0 * share) } else { text };
    if share > 0.0 && share < 5e-5 {
        return "<\u{a0}0.01\u{a0}%".to_owned();
    }
    // nearly all is not all
    let text = if share < 1.0 && text.starts_with("100") { "99.99".to_owned() } else { text };
    format!("{text}\u{a0}%")
}

/// A length such as 2 h 5 min or 12 min 30 s.
pub fn length(length_ns: i64) -> String {
    let seconds = unit::seconds(length_ns.max(0));
    let (h, min, s) = ((seconds / 3600.0).floor(), (seconds / 60.0).floor() % 60.0, seconds % 60.0);
    match (h > 0.0, min > 0.0) {
        (true, _) => format!("{h:.0} h {min:.0} min"),
        (_, true) => format!("{min:.0} min {:.0} s", s.floor()),
        _ => format!("{s:.1} s"),
    }
}

/// A time on the charts' clock.
pub fn clock(t_s: f64) -> String {
    crate::plot::clock(t_s, 1.0)
}

/// Date and time, UTC, of a time since 1970.
pub fn utc(ns: u64) -> String {
    let text = humantime::format_rfc3339_seconds(UNIX_EPOCH + Duration::from_nanos(ns)).to_string();
    text.replace('T', " ").trim_end_matches('Z').to_owned()
}

/// A latency with its unit.
pub fn time(us: f64) -> String {
    match us {
        us if us >= 1e6 => format!("{} s", digits(us / 1e6)),
        us if us >= 1e3 => format!("{} ms", digits(us / 1e3)),
        us => format!("{} µs", digits(us)),
    }
}

/// Numbers of a latency's axis, us.
pub fn latency_ticks(axis: &Axis) -> crate::plot::Ticks {
    let powers = (0..8).flat_map(|power| [1.0, 3.0].map(|factor| factor * 10f64.powi(power)));
    let text = |us: f64| match us {
        us if us >= 1e6 => format!("{} s", us / 1e6),
        us if us >= 1e3 => format!("{} ms", us / 1e3),
        us => format!("{us} µs"),
    };
    powers.map(|us| (axis.place(us), text(us))).filter(|(place, _)| (0.0..=1.0).contains(place)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_read_well() {
        assert_eq!([number(-0.001, 2), number(-1.256, 2), number(f64::NAN, 1)], ["0.00", "−1.26", "–"]);
        assert_eq!(
            [digits(0.012_34), digits(123.4), digits(0.0), digits(3.2e-8)],
            ["0.0123", "123", "0.000000", "3.20e−8"]
        );
        assert_eq!([count(7), count(150_001), count(1_234_567)], ["7", "150\u{202f}001", "1\u{202f}234\u{202f}567"]);
        assert_eq!(
            [percent(1.0), percent(0.999_999), percent(0.983), percent(1e-6), percent(0.0)],
            ["100\u{a0}%", "99.99\u{a0}%", "98.3\u{a0}%", "<\u{a0}0.01\u{a0}%", "0\u{a0}%"]
        );
        assert_eq!(
            [length(7_500_000_000_000), length(750_000_000_000), length(9_010_000_000)],
            ["2 h 5 min", "12 min 30 s", "9.0 s"]
        );
        assert_eq!(utc(1_700_000_000_123_456_789), "2023-11-14 22:13:20");
        assert_eq!([time(12.34), time(1234.0), time(2.5e6)], ["12.3 µs", "1.23 ms", "2.50 s"]);
    }
}
