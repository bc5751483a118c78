//! Frames out of a stream that may begin, break off and go on anywhere.

use std::fmt::Debug;

/// What stands at the beginning of some bytes.
#[derive(Clone, Debug, PartialEq)]
pub enum Look<F> {
    /// No frame begins here.
    Foreign,
    /// A frame may begin here; more bytes will tell.
    Short,
    /// A frame seems to begin here, but its check is wrong.
    Damaged,
    /// Bytes between frames that say nothing.
    Filler {
        /// How many.
        length: usize,
    },
    /// A frame.
    Whole {
        /// What it says.
        frame: F,
        /// How many bytes it takes.
        length: usize,
    },
}

/// How the frames of a device look.
pub trait Protocol {
    /// What a frame says.
    type Frame: Debug;
    /// The longest frame, bytes.
    const LONGEST: usize;
    /// Whether a header can hardly stand in other bytes by chance: then each wrong check is one of a frame.
    const DISTINCT: bool;

    /// Looks at the beginning of the bytes, of which there is at least one.
    fn look(bytes: &[u8]) -> Look<Self::Frame>;
}

/// What became of the bytes so far.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// Frames with a right check.
    pub good: u64,
    /// Frames with a wrong check.
    pub damaged: u64,
    /// Bytes that belong to no good frame.
    pub skipped: u64,
}

/// Finds the frames of a device in its stream.
///
/// Where no frame begins, or one with a wrong check, it drops one byte and looks again, so a good frame is found wherever it begins.
#[derive(Debug)]
pub struct Framer<P: Protocol> {
    held: Vec<u8>,
    /// Bytes of `held` that have been worked off.
    done: usize,
    in_step: bool,
    counts: Counts,
    protocol: std::marker::PhantomData<P>,
}

impl<P: Protocol> Default for Framer<P> {
    fn default() -> Self {
        Self {
            held: Vec::with_capacity(4 * P::LONGEST.min(4096)),
            done: 0,
            in_step: false,
            counts: Counts::default(),
            protocol: std::marker::PhantomData,
        }
    }
}

impl<P: Protocol> Framer<P> {
    /// Takes bytes as they come.
    pub fn push(&mut self, bytes: &[u8]) {
        self.held.drain(..self.done);
        self.done = 0;
        self.held.extend_from_slice(bytes);
    }

    /// The next good frame of what has been pushed; call until it gives `None`.
    pub fn next_frame(&mut self) -> Option<P::Frame> {
        while let Some(rest) = self.held.get(self.done..).filter(|rest| !rest.is_empty()) {
            match P::look(rest) {
                Look::Whole { frame, length } => {
                    self.done += length.clamp(1, rest.len());
                    self.counts.good += 1;
                    self.in_step = true;
                    return Some(frame);
                }
                Look::Filler { length } => self.done += length.clamp(1, rest.len()),
                // a promise of more than any frame has is none
                Look::Short if rest.len() < P::LONGEST => return None,
                Look::Damaged if P::DISTINCT || self.in_step => {
                    self.counts.damaged += 1;
                    self.drop_byte();
                }
                Look::Short | Look::Damaged | Look::Foreign => self.drop_byte(),
            }
        }
        None
    }

    fn drop_byte(&mut self) {
        self.done += 1;
        self.counts.skipped += 1;
        self.in_step = false;
    }

    /// What became of the bytes so far.
    pub fn counts(&self) -> Counts {
        self.counts
    }
}
