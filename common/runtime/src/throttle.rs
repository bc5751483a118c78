/// Lets a word through, and then none for a while: what changes all the time is told now and then, with what has come together.
#[derive(Clone, Copy, Debug)]
pub struct Throttle {
    pause_ns: i64,
    next_ns: i64,
}

impl Throttle {
    /// One word every `pause_ns` at most.
    pub fn new(pause_ns: i64) -> Self {
        Self { pause_ns, next_ns: i64::MIN }
    }

    /// Whether a word may be said now; the next one may be after the pause.
    pub fn pass(&mut self, now_ns: i64) -> bool {
        let passes = now_ns >= self.next_ns;
        if passes {
            self.next_ns = now_ns.saturating_add(self.pause_ns);
        }
        passes
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_word_passes_at_once_and_then_after_the_pause() {
        let mut throttle = Throttle::new(10);
        let passed: Vec<i64> = (0..35).filter(|now| throttle.pass(*now)).collect();
        assert_eq!(passed, [0, 10, 20, 30]);
    }
}
