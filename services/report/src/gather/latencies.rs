use super::{Envelope, Trace};
use messages::{FlexureParams, Solution};
use runtime::Latency;

/// How long the stages took, as the stamps of solutions and parameters tell.
#[derive(Clone, Debug)]
pub struct Latencies {
    /// From the sample's due time to its publication by the source.
    pub source: Latency,
    /// What the algorithm waited for a later sample of the sub unit.
    pub wait: Latency,
    /// From the last sample needed to the pair.
    pub synchronise: Latency,
    /// From the pair to the solution.
    pub estimate: Latency,
    /// From the solution that ended a window to its parameters.
    pub identify: Latency,
    /// From the sample's due time to the solution.
    pub whole: Latency,
    /// The whole against time, us.
    pub trace: Trace<Envelope>,
}

impl Latencies {
    /// Nothing yet, of solutions that come so often.
    pub fn new(interval_ns: i64) -> Self {
        let [source, wait, synchronise, estimate, identify, whole] = std::array::from_fn(|_| Latency::new());
        Self { source, wait, synchronise, estimate, identify, whole, trace: Trace::new(interval_ns) }
    }

    /// Takes the stamps of a solution.
    pub fn solution(&mut self, since_ns: i64, solution: &Solution) {
        let stamps = solution.header.stamps;
        record(&mut self.source, stamps.due_ns, stamps.source_ns);
        record(&mut self.wait, stamps.source_ns, stamps.complete_ns);
        record(&mut self.synchronise, stamps.complete_ns, stamps.pair_ns);
        record(&mut self.estimate, stamps.pair_ns, stamps.solution_ns);
        if let Some(whole_ns) = record(&mut self.whole, stamps.due_ns, stamps.solution_ns) {
            self.trace.take(since_ns, Envelope::of(whole_ns as f64 / 1e3));
        }
    }

    /// Takes the stamps of parameters.
    pub fn parameters(&mut self, set: &FlexureParams) {
        let stamps = set.header.stamps;
        record(&mut self.identify, stamps.solution_ns, stamps.parameters_ns);
    }

    /// All with their names, in the order of the data's way.
    pub fn all(&self) -> [(&'static str, &Latency); 6] {
        [
            ("source", &self.source),
            ("wait for the other unit", &self.wait),
            ("synchronise", &self.synchronise),
            ("estimate", &self.estimate),
            ("end to end", &self.whole),
            ("identify", &self.identify),
        ]
    }
}

/// Records what lies between two stamps; gives it. A stamp of 0 is none.
fn record(latency: &mut Latency, from_ns: i64, to_ns: i64) -> Option<i64> {
    if from_ns == 0 || to_ns == 0 {
        return None;
    }
    let taken_ns = to_ns.saturating_sub(from_ns);
    latency.record(taken_ns);
    Some(taken_ns)
}
