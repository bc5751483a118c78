//! Counters that wrap, and stamps with a coarse unit.

use crate::line::Line;

/// A number that a device counts up, with the values at which it may start again at 0.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Count {
    pub value: u32,
    pub moduli: &'static [u64],
}

/// By how much a count has gone on, given about how much it should have: of all steps that the wraps allow the nearest to it.
pub(crate) fn step(before: u32, now: Count, expected: f64) -> i64 {
    let plain = i64::from(now.value) - i64::from(before);
    let wrapped = now.moduli.iter().map(|&modulus| {
        let modulus = modulus as f64;
        plain + (((expected - plain as f64) / modulus).round() * modulus) as i64
    });
    let off = |step: &i64| (*step as f64 - expected).abs();
    wrapped.chain([plain]).min_by(|a, b| off(a).total_cmp(&off(b))).unwrap_or(plain)
}

/// Stamps of a coarse unit, made smooth: the device samples regularly, so that the number of a sample tells more than its rounding.
#[derive(Clone, Debug)]
pub(crate) struct Smooth {
    quantum_ns: i64,
    state: Option<(i64, Line)>,
}

impl Smooth {
    pub fn new(quantum_ns: i64) -> Self {
        Self { quantum_ns, state: None }
    }

    /// The smooth time of a stamp; `regular_ns` is what the sample's number says with the nominal interval.
    pub fn time_ns(&mut self, stamp_ns: i64, regular_ns: i64) -> i64 {
        let quantum = self.quantum_ns as f64 * 1e-9;
        let start = (stamp_ns - regular_ns, Line::new(regular_ns as f64 * 1e-9, 0.0, quantum, 1e-4));
        let (apart_ns, line) = self.state.get_or_insert(start);
        let at = regular_ns as f64 * 1e-9;
        let off = (stamp_ns - regular_ns - *apart_ns) as f64 * 1e-9;
        line.advance(at);
        let innovation = off - line.value(at);
        if innovation.abs() > 1.5 * quantum {
            // not regular, or a jump: the stamp itself is the best there is
            self.state = None;
            return stamp_ns;
        }
        line.correct(innovation, quantum * quantum / 12.0);
        regular_ns + *apart_ns + (line.value(at) * 1e9).round() as i64
    }

    pub fn restart(&mut self) {
        self.state = None;
    }
}
