//! Once warm, a step allocates nothing.
#![allow(clippy::unwrap_used)]

use simulation::*;
use std::alloc::{GlobalAlloc, Layout, System};
use std::sync::atomic::{AtomicUsize, Ordering};

struct Counting;

static ALLOCATIONS: AtomicUsize = AtomicUsize::new(0);

// SAFETY: every call goes to the system's allocator unchanged.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        ALLOCATIONS.fetch_add(1, Ordering::Relaxed);
        // SAFETY: the caller's promise is passed on.
        unsafe { System.alloc(layout) }
    }
    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        // SAFETY: the caller's promise is passed on.
        unsafe { System.dealloc(pointer, layout) }
    }
}

#[global_allocator]
static COUNTING: Counting = Counting;

#[test]
fn a_warm_step_allocates_nothing() {
    let wire = Wire {
        transit_s: 0.1,
        phase_s: 0.003,
        rate_error: 1e-4,
        loss: 0.01,
        duplicate: 0.01,
        swap: 0.01,
        ..Wire::default()
    };
    let in_phase_rotation = frames::Vec3::new(1e-4, 0.0, 0.0);
    let coupled = |response| Area {
        coupling: Some(Coupling { share: 0.1, response, in_phase_rotation }),
        impulses: Some(Impulses { factor: 50.0, probability: 5e-3, cell_s: 0.01 }),
        second_flexure: Some([GaussMarkov::damped(0.1, 0.3, 1e-4); 3]),
        events: vec![
            Event { at_s: 30.0, trouble: Trouble::StuckGyro(1) },
            Event { at_s: 40.0, trouble: Trouble::DeadAccelerometers },
            Event { at_s: 50.0, trouble: Trouble::Gap(5.0) },
            Event { at_s: 60.0, trouble: Trouble::DelayStep(0.02) },
        ],
        quasi_static: QuasiStatic { amplitude: [1e-3; 3], period: 7200.0, phase: [0.0; 3] },
        ..Area::default()
    };
    let responses = [
        Response::Phase { wander: 0.35, wander_tau: 9000.0 },
        Response::Delayed { delay_s: 1.5 },
        Response::Resonant { mu: 0.1, b: 1.5 },
    ];
    let areas = std::iter::once(Area { wire, ..Area::default() }).chain(responses.map(coupled)).collect();
    let roll = Swing::Random(RandomSwing { mu: 0.06, b: 0.44, sigma: 0.06, band_limit_hz: Some(0.4) });
    let pitch = Swing::Tones(Tones { rms: 0.05, period: 8.0, count: 24 });
    let sea_change = Some(SeaChange { at_s: 30.0, factor: 2.0, ramp_s: 60.0 });
    let ship = Ship { roll, pitch, sea_change, ..Ship::default() };
    let mut simulator = Simulator::new(&Scenario { ship, areas, duration_s: None, ..Scenario::default() });
    (0..2000).for_each(|_| _ = simulator.step());
    let before = ALLOCATIONS.load(Ordering::Relaxed);
    (0..20_000).for_each(|_| _ = simulator.step());
    assert_eq!(ALLOCATIONS.load(Ordering::Relaxed), before);
}
