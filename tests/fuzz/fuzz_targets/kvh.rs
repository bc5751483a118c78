#![no_main]

use libfuzzer_sys::fuzz_target;
use wire::Framer;
use wire::kvh::Kvh;

fuzz_target!(|data: &[u8]| {
    let mut framer = Framer::<Kvh>::default();
    for piece in data.chunks(17) {
        framer.push(piece);
        while framer.next_frame().is_some() {}
    }
    assert!(framer.counts().skipped <= data.len() as u64);
});
