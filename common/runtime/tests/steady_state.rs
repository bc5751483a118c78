//! Between waking and sleeping again a stage allocates nothing but what the transport does for itself.
#![allow(clippy::unwrap_used)]

use messages::{Solution, topic};
use runtime::{Domain, Latency, Node, Publisher, Subscriber, Waiter, monotonic_ns};
use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;
use std::time::Duration;

struct Counting;

thread_local! {
    static ALLOCATIONS: Cell<u64> = const { Cell::new(0) };
}

// SAFETY: every call is handed on to the system's allocator.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        ALLOCATIONS.with(|count| count.set(count.get() + 1));
        // SAFETY: the caller's duties are those of this function.
        unsafe { System.alloc(layout) }
    }
    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        // SAFETY: the caller's duties are those of this function.
        unsafe { System.dealloc(pointer, layout) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

fn allocations() -> u64 {
    ALLOCATIONS.with(Cell::get)
}

#[test]
fn a_stage_at_work_allocates_nothing() {
    let domain = Domain::create().unwrap();
    let node = Node::open(&domain, "node").unwrap();
    let reader = Subscriber::open(&node, &topic::solution("aft")).unwrap();
    let writer = Publisher::open(&node, &topic::solution("aft")).unwrap();
    let (mut waiter, mut latency) = (Waiter::new(), Latency::new());
    let mut rounds = |count: u64| {
        let (mut sending, start) = (0, allocations());
        for _ in 0..count {
            let (before, now) = (allocations(), monotonic_ns());
            writer.publish(&Solution::default()).unwrap();
            sending += allocations() - before;
            writer.refresh().unwrap();
            waiter.wait(&[&reader], Duration::from_secs(1)).unwrap();
            while reader.take().unwrap().is_some() {
                latency.record(monotonic_ns() - now);
            }
        }
        (sending, allocations() - start - sending)
    };
    rounds(10);
    // More than the topic's depth, so that memory comes round. The one of each sending is the transport's own, 48 bytes.
    assert_eq!(rounds(10_000), (10_000, 0));
    assert_eq!(latency.summary().count, 10_010);
}
