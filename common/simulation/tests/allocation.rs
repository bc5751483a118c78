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
    let areas = vec![Area { wire, ..Area::default() }, Area::default()];
    let mut simulator = Simulator::new(&Scenario { areas, duration_s: None, ..Scenario::default() });
    (0..2000).for_each(|_| _ = simulator.step());
    let before = ALLOCATIONS.load(Ordering::Relaxed);
    (0..20_000).for_each(|_| _ = simulator.step());
    assert_eq!(ALLOCATIONS.load(Ordering::Relaxed), before);
}
