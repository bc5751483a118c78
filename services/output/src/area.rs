use messages::{Header, Solution, topic};
use runtime::{Node, Sequence, Subscriber, TransportError, Wake, monotonic_ns};
use telegrams::{Track, instant_ns};

/// The solutions of one area.
pub struct AreaInput {
    index: usize,
    solutions: Subscriber<Solution>,
    track: Track,
    sequence: Sequence,
    taken: u64,
    last: Option<Header>,
    newest_ns: i64,
    ended: bool,
}

impl AreaInput {
    pub fn open(node: &Node, index: usize, name: &str) -> Result<Self, TransportError> {
        Ok(Self {
            index,
            solutions: Subscriber::open(node, &topic::solution(name))?,
            track: Track::default(),
            sequence: Sequence::default(),
            taken: 0,
            last: None,
            newest_ns: monotonic_ns(),
            ended: false,
        })
    }

    /// The next solution that has come; the track has seen it.
    pub fn next(&mut self) -> Result<Option<Solution>, TransportError> {
        let Some(solution) = self.solutions.take()? else { return Ok(None) };
        if solution.header.is_end() {
            self.ended = true;
            return Ok(None);
        }
        self.sequence.see(&solution.header);
        self.taken += 1;
        self.track.see(&solution);
        self.last = Some(solution.header);
        self.newest_ns = self.newest_ns.max(instant_ns(&solution.header));
        Ok(Some(solution))
    }

    /// The instant of the newest solution on the monotonic clock, ns; before there is one, that of the start.
    pub fn newest_ns(&self) -> i64 {
        self.newest_ns
    }

    pub fn index(&self) -> usize {
        self.index
    }

    pub fn track(&self) -> &Track {
        &self.track
    }

    pub fn wake(&self) -> &dyn Wake {
        &self.solutions
    }

    pub fn last(&self) -> Option<&Header> {
        self.last.as_ref()
    }

    pub fn taken(&self) -> u64 {
        self.taken
    }

    pub fn lost(&self) -> u64 {
        self.sequence.lost()
    }

    pub fn ended(&self) -> bool {
        self.ended
    }
}
