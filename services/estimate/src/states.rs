//! The estimator's whole state for whoever records. The filter waits for nothing: it copies the state, another thread makes bytes of it, and some
//! parts of them go out behind each solution.

use crossbeam::channel::{Receiver, Sender, bounded};
use estimation::{Estimator, Frozen};
use messages::{Header, STATE_PART, StatePart, StateWish, topic};
use runtime::{Area, Node, Publisher, Subscriber, TransportError};
use std::thread;

/// Distance of two states once somebody has asked, ns.
const EVERY_NS: i64 = 60_000_000_000;
/// Where there is none yet, another try is made after so long, ns.
const RETRY_NS: i64 = 1_000_000_000;
/// So many parts go out behind a solution.
const AT_ONCE: usize = 4;

/// Makes bytes of copied states, in a thread of its own.
pub struct Encoder {
    frozen: Sender<(Header, Frozen)>,
    encoded: Receiver<(Header, Vec<u8>)>,
}

impl Encoder {
    /// Starts the thread, which ends with the encoder.
    ///
    /// # Errors
    /// The operating system refuses a thread.
    pub fn start() -> Result<Self, TransportError> {
        let (frozen, work) = bounded::<(Header, Frozen)>(1);
        let (done, encoded) = bounded(1);
        let encode = move || work.iter().try_for_each(|(header, frozen)| done.send((header, frozen())));
        let thread = thread::Builder::new().name("states".into()).spawn(encode);
        thread.map_err(|source| TransportError::System { call: "starting a thread", source })?;
        Ok(Self { frozen, encoded })
    }
}

/// The way of an estimator's states.
pub struct States {
    wishes: Subscriber<StateWish>,
    parts: Publisher<StatePart>,
    encoder: Encoder,
    area: u32,
    /// When the next one is due, ns of data time; `None` while nobody has asked.
    due_ns: Option<i64>,
    /// Whether one has been copied that has not gone out.
    under_way: bool,
    /// What goes out, and up to where it has.
    sending: Option<(Header, Vec<u8>, usize)>,
}

impl States {
    /// Opens the ports of an area.
    ///
    /// # Errors
    /// The transport refuses.
    pub fn open(node: &Node, encoder: Encoder, area: Area) -> Result<Self, TransportError> {
        Ok(Self {
            wishes: Subscriber::open(node, &topic::state_wish(area.name))?,
            parts: Publisher::open(node, &topic::state(area.name))?,
            encoder,
            area: area.index,
            due_ns: None,
            under_way: false,
            sending: None,
        })
    }

    /// Does what is due behind the solution of a pair.
    ///
    /// # Errors
    /// The transport refuses.
    pub fn see(&mut self, estimator: &dyn Estimator, header: &Header) -> Result<(), TransportError> {
        while self.wishes.take()?.is_some() {
            self.due_ns = Some(i64::MIN);
        }
        if !self.under_way && self.due_ns.is_some_and(|due_ns| header.time_ns >= due_ns) {
            let pause_ns = match estimator.freeze() {
                Some(frozen) => {
                    self.under_way = self.encoder.frozen.try_send((*header, frozen)).is_ok();
                    EVERY_NS
                }
                None => RETRY_NS,
            };
            self.due_ns = Some(header.time_ns.saturating_add(pause_ns));
        }
        if self.sending.is_none() && self.under_way {
            self.sending = self.encoder.encoded.try_recv().ok().map(|(header, bytes)| (header, bytes, 0));
        }
        (0..AT_ONCE).try_for_each(|_| self.send())
    }

    /// Sends the next part of what goes out.
    fn send(&mut self) -> Result<(), TransportError> {
        let Some((header, bytes, offset)) = &mut self.sending else { return Ok(()) };
        let rest = &bytes[*offset..];
        let rest = &rest[..rest.len().min(STATE_PART)];
        let (length, from) = (bytes.len() as u64, *offset as u64);
        let mut part = StatePart { header: *header, length, offset: from, area: self.area, ..StatePart::default() };
        part.bytes[..rest.len()].copy_from_slice(rest);
        self.parts.publish(&part)?;
        *offset += rest.len();
        if *offset == bytes.len() {
            (self.sending, self.under_way) = (None, false);
        }
        Ok(())
    }
}
