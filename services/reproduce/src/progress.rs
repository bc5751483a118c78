use experiments::Watch;
use indicatif::{ProgressBar, ProgressStyle};
use std::time::Duration;

/// A bar with the time left on a terminal's standard error; nothing without a terminal.
pub struct Bar(ProgressBar);

impl Bar {
    /// For so much work.
    pub fn new(cost: u64) -> Self {
        let bar = ProgressBar::new(cost);
        let bar = match ProgressStyle::with_template("{bar:40} {percent:>3} %, {eta} left") {
            Ok(style) => bar.with_style(style),
            Err(_) => bar,
        };
        if !bar.is_hidden() {
            // a trial may take minutes, and the time left must go on meanwhile
            bar.enable_steady_tick(Duration::from_millis(500));
        }
        Self(bar)
    }

    /// Takes it off the terminal.
    pub fn clear(&self) {
        self.0.finish_and_clear();
    }
}

impl Watch for Bar {
    fn done(&self, cost: u64) {
        self.0.inc(cost);
    }
}
