use frames::unit::seconds;

/// A stream that has come and stays away for so long is lost, ns.
const SILENCE_NS: i64 = 1_000_000_000;

/// Tells once when a stream that had come stays away, and when it is back.
#[derive(Debug)]
pub struct Supply {
    what: String,
    last_ns: Option<i64>,
    lost: bool,
}

impl Supply {
    /// Of a stream that has not come yet; `what` is its name in the plural.
    pub fn new(what: impl Into<String>) -> Self {
        Self { what: what.into(), last_ns: None, lost: false }
    }

    /// For each pass of a stage's loop: whether something has come since the one before.
    pub fn see(&mut self, came: bool, now_ns: i64) {
        let silent_ns = self.last_ns.map_or(0, |last_ns| now_ns - last_ns);
        if came {
            self.last_ns = Some(now_ns);
        }
        if came && self.lost {
            tracing::info!(silent_s = seconds(silent_ns), "{} come again", self.what);
        } else if !came && !self.lost && silent_ns > SILENCE_NS {
            tracing::warn!(silent_s = seconds(silent_ns), "no {} come any more", self.what);
        }
        self.lost = !came && (self.lost || silent_ns > SILENCE_NS);
    }

    /// Whether it stays away.
    pub fn is_lost(&self) -> bool {
        self.lost
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_stream_is_lost_after_a_second_and_back_with_its_first_message() {
        let mut pairs = Supply::new("pairs");
        let mut seen = Vec::new();
        for tenth in 0..60 {
            // it begins after half a second and breaks off from 1.0 to 3.0 s and from 4.0 to 4.9 s
            let came = tenth >= 5 && !(10..30).contains(&tenth) && !(40..49).contains(&tenth);
            pairs.see(came, tenth * 100_000_000);
            seen.push(pairs.is_lost());
        }
        let lost: Vec<usize> = (0..60).filter(|tenth| seen[*tenth]).collect();
        assert_eq!(lost, (20..30).collect::<Vec<usize>>());
    }
}
