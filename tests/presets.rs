//! Every system of the papers also runs as processes, and gives the bits of the offline loop.
#![allow(clippy::unwrap_used)]

mod common;

use common::{Place, comparison};
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;

/// So many run at a time: most of the time they wait for the next sample. One takes about a sixteenth of a core.
const TOGETHER: usize = 12;

#[test]
fn every_preset_gives_the_same_live_and_offline() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("config/papers");
    let mut presets: Vec<PathBuf> = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    presets.sort();
    assert!(presets.len() > 20, "{presets:?}");
    let next = AtomicUsize::new(0);
    thread::scope(|scope| {
        for _ in 0..TOGETHER {
            scope.spawn(|| {
                while let Some(preset) = presets.get(next.fetch_add(1, Ordering::Relaxed)) {
                    let live = comparison::same_live_and_offline(&Place::new(), preset, "20s");
                    assert_eq!(live.not_logged(), "", "{}", preset.display());
                }
            });
        }
    });
}
