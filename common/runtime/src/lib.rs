//! The shell: transport, clocks, scheduling and latency. The only place with iceoryx2, clocks, signals and real-time scheduling.
//!
//! A launch owns a [`Domain`], a transport of its own. Each stage opens a [`Node`] in it, a [`Publisher`] or [`Subscriber`] for
//! every topic it uses, and sleeps in a [`Waiter`] until one of them has news:
//!
//! ```no_run
//! # use runtime::{Domain, Node, Publisher, Stop, Subscriber, TransportError, Waiter};
//! # use std::time::Duration;
//! # fn main() -> Result<(), TransportError> {
//! let domain = Domain::open("/run/user/1000/deckflex-1000/df0123abcd".as_ref())?;
//! let node = Node::open(&domain, "estimate/aft")?;
//! let pairs = Subscriber::open(&node, &messages::topic::pair("aft"))?;
//! let solutions = Publisher::open(&node, &messages::topic::solution("aft"))?;
//! let (stop, mut waiter) = (Stop::install()?, Waiter::new());
//! while !stop.requested() {
//!     waiter.wait(&[&pairs], Duration::from_millis(200))?;
//!     while let Some(_pair) = pairs.take()? {
//!         solutions.publish(&messages::Solution::default())?;
//!     }
//! }
//! # Ok(())
//! # }
//! ```

mod clock;
mod context;
mod domain;
mod error;
mod feed;
mod gap;
mod growth;
mod latency;
mod launches;
pub mod line;
pub mod log;
mod mender;
mod node;
mod owner;
mod port;
pub mod scheduling;
mod service;
mod signal;
mod stage;
mod supply;
mod throttle;
mod utc;
mod waiter;
mod wire;

pub use clock::{Pacer, monotonic_ns, sleep_until};
pub use context::Context;
pub use domain::{Domain, Running};
pub use error::{POISONED_EXIT_CODE, TransportError};
pub use feed::{Delivery, Feed};
pub use gap::Sequence;
pub use growth::Growth;
pub use latency::{IntervalLog, Latency, Summary};
pub use launches::{Launch, Lookout};
pub use node::Node;
pub use port::{Anchor, Publisher, Subscriber};
pub use signal::{Stop, die_with_parent, fail_beyond_file_limit};
pub use stage::{Area, Beat, Connection};
pub use supply::Supply;
pub use throttle::Throttle;
pub use utc::{HostUtc, host_utc};
pub use waiter::{Waiter, Wake};
pub use wire::Wire;
