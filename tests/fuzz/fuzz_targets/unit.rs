#![no_main]

use libfuzzer_sys::fuzz_target;
use wire::{Angle, Device, Rotation, Settings, Unit};

const DEVICES: [Device; 3] = [
    Device::Kvh { rotation: Rotation::Rate, angle: Angle::Degrees },
    Device::Stdbin,
    Device::Stim300 { rotation: Rotation::Rate, force_exponent: 19 },
];

// the first byte says which device; before each piece of a stream stands how long it took to come, in milliseconds
fuzz_target!(|data: &[u8]| {
    let Some((first, mut rest)) = data.split_first() else { return };
    let device = DEVICES[usize::from(first % 3)];
    let settings = Settings { device, interval_ns: 10_000_000, latency_ns: 0, unit: 0, run_id: 0, epoch_ns: 0 };
    let mut unit = Unit::new(settings);
    let mut arrival_ns = 1_000_000_000;
    while let Some((wait, tail)) = rest.split_first() {
        let (piece, tail) = tail.split_at(tail.len().min(41));
        arrival_ns += i64::from(*wait) * 1_000_000;
        unit.push(arrival_ns, piece);
        while unit.next_sample().is_some() {}
        rest = tail;
    }
});
