use messages::Header;

/// Counts the messages of a stream that never arrived, by the gaps in their sequence numbers.
///
/// Each run counts for itself: the first message of a run opens no gap, whatever its number.
#[derive(Clone, Debug, Default)]
pub struct Sequence {
    last: Option<(u64, u64)>,
    lost: u64,
}

impl Sequence {
    /// Looks at the next message and gives the number of those missing just before it. Marks of the end and messages that are not
    /// newer than the last one are passed over.
    pub fn see(&mut self, header: &Header) -> u64 {
        if header.is_end() {
            return 0;
        }
        let missing = match self.last {
            Some((run_id, last)) if run_id == header.run_id => match header.sequence.checked_sub(last) {
                None | Some(0) => return 0,
                Some(step) => step - 1,
            },
            _ => 0,
        };
        self.last = Some((header.run_id, header.sequence));
        self.lost += missing;
        missing
    }

    /// How many were missing in all runs together.
    pub fn lost(&self) -> u64 {
        self.lost
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn header(run_id: u64, sequence: u64) -> Header {
        Header { run_id, sequence, ..Header::default() }
    }

    #[test]
    fn a_gap_is_counted_once() {
        let mut sequence = Sequence::default();
        let missing: Vec<u64> = [5, 6, 9, 10].map(|k| sequence.see(&header(1, k))).to_vec();
        assert_eq!(missing, [0, 0, 2, 0]);
        assert_eq!(sequence.lost(), 2);
    }

    #[test]
    fn a_new_run_starts_without_a_gap() {
        let mut sequence = Sequence::default();
        for (run_id, k) in [(1, 0), (1, 1), (2, 40), (2, 42), (1, 7)] {
            sequence.see(&header(run_id, k));
        }
        assert_eq!(sequence.lost(), 1);
    }

    #[test]
    fn the_end_and_old_messages_do_not_count() {
        let mut sequence = Sequence::default();
        sequence.see(&header(1, 3));
        assert_eq!(sequence.see(&Header { end: 1, ..header(1, 100) }), 0);
        assert_eq!(sequence.see(&header(1, 3)), 0);
        assert_eq!(sequence.see(&header(1, 1)), 0);
        assert_eq!(sequence.see(&header(1, 4)), 0, "an old message must not move the count back");
        assert_eq!(sequence.lost(), 0);
    }
}
