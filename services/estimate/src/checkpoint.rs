//! What an estimator that takes the place of one that died can go on from.

use crossbeam::channel::{Sender, bounded};
use messages::{FlexureParams, Header, Solution};
use runtime::TransportError;
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};
use std::{fs, io, thread};

/// Distance of two checkpoints, ns.
const EVERY_NS: i64 = 1_000_000_000;

/// Static part, delay and flexure model, in the units of the messages.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Checkpoint {
    time_ns: i64,
    static_q: [f64; 4],
    static_covariance: [f64; 9],
    delay: f64,
    delay_sigma: f64,
    parameters: Option<Parameters>,
}

/// The set in force.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
struct Parameters {
    id: u64,
    window_begin_ns: i64,
    effective_from_ns: i64,
    mu: [f64; 3],
    b: [f64; 3],
    sigma: [f64; 3],
    second_mu: [f64; 3],
    second_b: [f64; 3],
    second_sigma: [f64; 3],
}

impl Checkpoint {
    /// Of a valid solution, with the last set that was offered.
    fn of(solution: &Solution, offered: Option<&FlexureParams>) -> Self {
        let parameters = offered.map(|set| Parameters {
            id: set.id,
            window_begin_ns: set.window_begin_ns,
            effective_from_ns: set.effective_from_ns,
            mu: set.mu,
            b: set.b,
            sigma: set.sigma,
            second_mu: set.second_mu,
            second_b: set.second_b,
            second_sigma: set.second_sigma,
        });
        Self {
            time_ns: solution.header.time_ns,
            static_q: solution.static_q,
            static_covariance: solution.static_covariance,
            delay: solution.delay,
            delay_sigma: solution.delay_sigma,
            parameters,
        }
    }

    /// What was kept; `None` where nothing was, or nothing that can be read.
    pub fn read(path: &Path) -> Option<Self> {
        serde_json::from_slice(&fs::read(path).ok()?).ok()
    }

    /// As a solution, in which nothing else is filled in.
    pub fn solution(&self) -> Solution {
        let Self { time_ns, static_q, static_covariance, delay, delay_sigma, .. } = *self;
        let header = Header { time_ns, ..Header::default() };
        Solution { header, static_q, static_covariance, delay, delay_sigma, valid: 1, ..Solution::default() }
    }

    /// The flexure model; `None` where the estimator had none yet.
    pub fn parameters(&self) -> Option<FlexureParams> {
        let Parameters { id, window_begin_ns, effective_from_ns, mu, b, sigma, second_mu, second_b, second_sigma } =
            self.parameters?;
        Some(FlexureParams {
            id,
            window_begin_ns,
            effective_from_ns,
            mu,
            b,
            sigma,
            second_mu,
            second_b,
            second_sigma,
            ..FlexureParams::default()
        })
    }
}

/// Keeps a checkpoint in a file, in a thread of its own: the filter never waits for a disk.
pub struct Keeper {
    sender: Sender<Checkpoint>,
    last_ns: i64,
}

impl Keeper {
    /// Starts the thread, which ends with the keeper, or when the file cannot be written: then an estimator that takes over has to register.
    ///
    /// # Errors
    /// The operating system refuses a thread.
    pub fn start(path: PathBuf) -> Result<Self, TransportError> {
        let (sender, receiver) = bounded::<Checkpoint>(1);
        let write = move || receiver.iter().try_for_each(|checkpoint| write(&path, &checkpoint));
        let thread = thread::Builder::new().name("checkpoint".into()).spawn(write);
        thread.map_err(|source| TransportError::System { call: "starting a thread", source })?;
        Ok(Self { sender, last_ns: i64::MIN })
    }

    /// Keeps what a valid solution says, once a second.
    pub fn see(&mut self, solution: &Solution, offered: Option<&FlexureParams>) {
        let time_ns = solution.header.time_ns;
        if solution.is_valid() && time_ns.saturating_sub(self.last_ns) >= EVERY_NS {
            // the thread may still be writing the one before
            let _ = self.sender.try_send(Checkpoint::of(solution, offered));
            self.last_ns = time_ns;
        }
    }
}

/// Whoever reads finds the old file or the new one.
fn write(path: &Path, checkpoint: &Checkpoint) -> io::Result<()> {
    let half = path.with_extension("half");
    fs::write(&half, serde_json::to_vec(checkpoint)?)?;
    fs::rename(&half, path)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::time::{Duration, Instant};

    fn solution(time_ns: i64) -> Solution {
        let header = Header { time_ns, ..Header::default() };
        let static_q = [0.8, 0.0, 0.6, 0.0];
        Solution { header, static_q, delay: 1e-3, delay_sigma: 1e-4, valid: 1, ..Solution::default() }
    }

    #[test]
    fn the_last_valid_solution_is_kept_with_its_model() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("estimate_0.json");
        let set = FlexureParams { id: 7, b: [0.1, 0.2, 1.0 / 3.0], ..FlexureParams::default() };
        let mut keeper = Keeper::start(path.clone()).expect("a thread");
        keeper.see(&Solution { valid: 0, ..solution(1) }, Some(&set));
        keeper.see(&solution(2), Some(&set));
        keeper.see(&solution(EVERY_NS), Some(&set));
        let until = Instant::now() + Duration::from_secs(10);
        let kept = loop {
            match Checkpoint::read(&path) {
                Some(kept) => break kept,
                None => assert!(Instant::now() < until, "nothing was written"),
            }
            thread::sleep(Duration::from_millis(5));
        };
        assert_eq!(kept, Checkpoint::of(&solution(2), Some(&set)));
        assert_eq!((kept.solution().static_q, kept.solution().delay), (solution(2).static_q, 1e-3));
        assert_eq!(kept.parameters().map(|set| (set.id, set.b)), Some((7, set.b)));
    }

    #[test]
    fn what_cannot_be_read_is_no_checkpoint() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("estimate_0.json");
        assert_eq!(Checkpoint::read(&path), None);
        fs::write(&path, "{\"time_ns\": 1").expect("written");
        assert_eq!(Checkpoint::read(&path), None);
    }
}
