//! Where in a recording that begins in the middle of a run a replay can start.

use messages::StatePart;

/// The state of an area's estimator.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Start {
    /// The last sample that the state has seen: its number.
    pub number: u64,
    /// Its time, ns.
    pub time_ns: i64,
    /// The state's bytes.
    pub state: Vec<u8>,
}

/// Puts the parts of an area's states together, and keeps the first one behind which all pairs are recorded.
#[derive(Debug, Default)]
pub(super) struct Starts {
    first_pair: Option<u64>,
    filling: Option<Start>,
    found: Option<Start>,
}

impl Starts {
    /// Takes the number of the next recorded pair.
    pub fn pair(&mut self, number: u64) {
        let first = *self.first_pair.get_or_insert(number);
        self.found.take_if(|start| !is_before(first, start));
    }

    /// Takes the next part of a state; one that lacks a part is none.
    pub fn part(&mut self, part: &StatePart) {
        let number = part.header.sequence;
        if part.offset == 0 {
            self.filling = Some(Start { number, time_ns: part.header.time_ns, state: Vec::new() });
        }
        let follows = |start: &Start| start.number == number && start.state.len() as u64 == part.offset;
        let Some(mut start) = self.filling.take().filter(follows) else { return };
        let rest = usize::try_from(part.length.saturating_sub(part.offset)).unwrap_or(usize::MAX);
        start.state.extend_from_slice(&part.bytes[..rest.min(part.bytes.len())]);
        if (start.state.len() as u64) < part.length {
            self.filling = Some(start);
        } else if self.found.is_none() && self.first_pair.is_none_or(|first| is_before(first, &start)) {
            self.found = Some(start);
        }
    }

    /// The first state that is of use, if pairs are recorded at all.
    pub fn finish(self) -> Option<Start> {
        self.first_pair.and(self.found)
    }
}

/// Whether no pair behind the state was there before the first recorded one.
fn is_before(first_pair: u64, start: &Start) -> bool {
    first_pair <= start.number.saturating_add(1)
}

#[cfg(test)]
mod tests {
    use super::*;
    use messages::{Header, STATE_PART};

    const LENGTH: usize = 2 * STATE_PART + 5;

    fn parts(number: u64) -> Vec<StatePart> {
        let header = Header { sequence: number, time_ns: number as i64, ..Header::default() };
        let bytes = [number as u8; STATE_PART];
        let part = |offset| StatePart { header, length: LENGTH as u64, offset, bytes, ..StatePart::default() };
        (0..LENGTH as u64).step_by(STATE_PART).map(part).collect()
    }

    fn number(starts: Starts) -> Option<u64> {
        starts.finish().map(|start| {
            assert_eq!((start.state.len(), start.time_ns), (LENGTH, start.number as i64));
            start.number
        })
    }

    #[test]
    fn the_first_state_with_all_pairs_behind_it_is_found() {
        let mut starts = Starts::default();
        parts(6).iter().for_each(|part| starts.part(part));
        (10..20).for_each(|number| starts.pair(number));
        for number in [8, 9, 15] {
            parts(number).iter().for_each(|part| starts.part(part));
        }
        assert_eq!(number(starts), Some(9));
    }

    #[test]
    fn what_is_not_whole_is_no_state() {
        let mut starts = Starts::default();
        starts.pair(1);
        let (two, three, four) = (parts(2), parts(3), parts(4));
        // without its beginning, with a hole, and another one's end
        let mixed = [&two[1], &two[2], &three[0], &three[2], &four[0], &two[1], &four[1]];
        mixed.into_iter().for_each(|part| starts.part(part));
        assert_eq!(number(starts), None);
        let mut starts = Starts::default();
        parts(2).iter().for_each(|part| starts.part(part));
        assert_eq!(number(starts), None, "there are no pairs");
    }
}
