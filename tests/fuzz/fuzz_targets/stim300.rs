#![no_main]

use libfuzzer_sys::fuzz_target;
use wire::Framer;
use wire::stim300::Stim300;

fuzz_target!(|data: &[u8]| {
    let mut framer = Framer::<Stim300>::default();
    for piece in data.chunks(17) {
        framer.push(piece);
        while framer.next_frame().is_some() {}
    }
    assert!(framer.counts().skipped <= data.len() as u64);
});
