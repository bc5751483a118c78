/// What changes all the time is told so often, ns.
const PAUSE_NS: i64 = 10_000_000_000;

/// Lets a word through, and then none for ten seconds: what changes all the time is told now and then, with what has come together.
#[derive(Clone, Copy, Debug)]
pub struct Throttle {
    next_ns: i64,
}

impl Default for Throttle {
    fn default() -> Self {
        Self { next_ns: i64::MIN }
    }
}

impl Throttle {
    /// Whether a word may be said now; the next one may be after the pause.
    pub fn pass(&mut self, now_ns: i64) -> bool {
        let passes = now_ns >= self.next_ns;
        if passes {
            self.next_ns = now_ns.saturating_add(PAUSE_NS);
        }
        passes
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_word_passes_at_once_and_then_after_the_pause() {
        let mut throttle = Throttle::default();
        let passed: Vec<i64> = (0..35).filter(|now_s| throttle.pass(now_s * 1_000_000_000)).collect();
        assert_eq!(passed, [0, 10, 20, 30]);
    }
}
