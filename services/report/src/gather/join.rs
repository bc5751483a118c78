use messages::{Solution, Truth};
use std::collections::VecDeque;

/// The recorder takes one topic after the other, so a truth may stand so many messages before or behind its solution.
const WAITING: usize = 4096;

/// Brings solutions together with their truths.
#[derive(Clone, Debug, Default)]
pub struct Join {
    solutions: VecDeque<Solution>,
    truths: VecDeque<Truth>,
}

impl Join {
    /// Takes a truth.
    pub fn truth(&mut self, truth: &Truth) {
        if self.truths.len() == WAITING {
            self.truths.pop_front();
        }
        self.truths.push_back(*truth);
    }

    /// Takes a solution.
    pub fn solution(&mut self, solution: &Solution) {
        self.solutions.push_back(*solution);
    }

    /// The next solution whose truth is there or can no more be waited for; at the end of the recording nothing is waited for.
    pub fn next(&mut self, at_end: bool) -> Option<(Solution, Option<Truth>)> {
        let number = self.solutions.front()?.header.sequence;
        while self.truths.front().is_some_and(|truth| truth.header.sequence < number) {
            self.truths.pop_front();
        }
        if self.truths.is_empty() && !at_end && self.solutions.len() < WAITING {
            return None;
        }
        let truth = self.truths.pop_front_if(|truth| truth.header.sequence == number);
        Some((self.solutions.pop_front()?, truth))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use messages::Header;

    fn header(sequence: u64) -> Header {
        Header { sequence, ..Header::default() }
    }

    #[test]
    fn truths_find_their_solutions_from_before_and_from_behind() {
        let mut join = Join::default();
        let mut found = Vec::new();
        let mut all = |join: &mut Join, at_end| {
            while let Some((solution, truth)) = join.next(at_end) {
                found.push((solution.header.sequence, truth.map(|truth| truth.header.sequence)));
            }
        };
        (0..3).for_each(|n| join.truth(&Truth { header: header(n), ..Truth::default() }));
        (1..6).for_each(|n| join.solution(&Solution { header: header(n), ..Solution::default() }));
        all(&mut join, false);
        [3, 5].into_iter().for_each(|n| join.truth(&Truth { header: header(n), ..Truth::default() }));
        join.solution(&Solution { header: header(6), ..Solution::default() });
        all(&mut join, false);
        all(&mut join, true);
        assert_eq!(found, [(1, Some(1)), (2, Some(2)), (3, Some(3)), (4, None), (5, Some(5)), (6, None)]);
    }

    #[test]
    fn without_truths_solutions_wait_for_so_long_only() {
        let mut join = Join::default();
        let given = (0..10_000u64).filter(|n| {
            join.solution(&Solution { header: header(*n), ..Solution::default() });
            join.next(false).is_some()
        });
        assert_eq!(given.count(), 10_001 - WAITING);
    }
}
