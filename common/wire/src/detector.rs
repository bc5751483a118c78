use crate::Family;
use crate::framer::{Framer, Protocol};
use crate::kvh::Kvh;
use crate::stdbin::Stdbin;
use crate::stim300::Stim300;

/// So many good frames, each with a right check, are no chance.
const ENOUGH: u64 = 3;

/// Tells which device a stream looks like.
#[derive(Debug, Default)]
pub struct Detector {
    kvh: Framer<Kvh>,
    stdbin: Framer<Stdbin>,
    stim300: Framer<Stim300>,
}

impl Detector {
    /// Takes bytes as they come.
    pub fn push(&mut self, bytes: &[u8]) {
        take(&mut self.kvh, bytes);
        take(&mut self.stdbin, bytes);
        take(&mut self.stim300, bytes);
    }

    /// The device with the most good frames so far; `None` while there are too few of each.
    pub fn found(&self) -> Option<Family> {
        let good = [
            (self.kvh.counts().good, Family::Kvh),
            (self.stdbin.counts().good, Family::Stdbin),
            (self.stim300.counts().good, Family::Stim300),
        ];
        good.into_iter().filter(|(good, _)| *good >= ENOUGH).max_by_key(|(good, _)| *good).map(|(_, family)| family)
    }
}

fn take<P: Protocol>(framer: &mut Framer<P>, bytes: &[u8]) {
    framer.push(bytes);
    while framer.next_frame().is_some() {}
}
