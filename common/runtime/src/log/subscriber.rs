use super::Speaker;
use super::fields::Fields;
use super::line::Line;
use super::outlet::Outlet;
use std::sync::Arc;
use std::time::SystemTime;
use tracing::level_filters::LevelFilter;
use tracing::span::{Attributes, Id, Record};
use tracing::subscriber::Interest;
use tracing::{Event, Metadata};

/// Takes the events of this process. It knows no spans: whoever speaks is one stage.
pub struct Subscriber {
    least: LevelFilter,
    speaker: Arc<Speaker>,
    outlet: Arc<Outlet>,
}

impl Subscriber {
    pub fn new(least: LevelFilter, speaker: Speaker, outlet: Arc<Outlet>) -> Self {
        Self { least, speaker: Arc::new(speaker), outlet }
    }
}

impl tracing::Subscriber for Subscriber {
    /// Asked once a place in the code, so that an event which is not wanted costs a comparison.
    fn register_callsite(&self, metadata: &'static Metadata<'static>) -> Interest {
        if self.enabled(metadata) { Interest::always() } else { Interest::never() }
    }

    fn enabled(&self, metadata: &Metadata<'_>) -> bool {
        metadata.is_event() && *metadata.level() <= self.least
    }

    fn max_level_hint(&self) -> Option<LevelFilter> {
        Some(self.least)
    }

    fn event(&self, event: &Event<'_>) {
        let metadata = event.metadata();
        let mut fields = Fields::default();
        event.record(&mut fields);
        let line = Line {
            time: SystemTime::now(),
            level: *metadata.level(),
            target: metadata.target(),
            place: metadata.file().zip(metadata.line()),
            fields,
        };
        self.outlet.give(line, &self.speaker);
    }

    fn new_span(&self, _: &Attributes<'_>) -> Id {
        Id::from_u64(1)
    }

    fn record(&self, _: &Id, _: &Record<'_>) {}

    fn record_follows_from(&self, _: &Id, _: &Id) {}

    fn enter(&self, _: &Id) {}

    fn exit(&self, _: &Id) {}
}
