//! What a replay of each file needs to begin in: the estimators' states, which they give when they are asked.

use messages::{StateWish, topic};
use pipeline::configuration::{Configuration, RecordTopic};
use runtime::{Node, Publisher, TransportError};

/// The wishes for states, one an area.
pub struct Wishes {
    publishers: Vec<Publisher<StateWish>>,
    /// Files for which states have been asked for.
    files: u64,
}

impl Wishes {
    /// Opens them; none where states are not recorded.
    pub fn open(node: &Node, configuration: &Configuration, wanted: &[RecordTopic]) -> Result<Self, TransportError> {
        let areas = configuration.areas.iter().filter(|_| wanted.contains(&RecordTopic::States));
        let publishers = areas.map(|area| Publisher::open(node, &topic::state_wish(&area.name)));
        Ok(Self { publishers: publishers.collect::<Result<_, _>>()?, files: 0 })
    }

    /// Asks once a file, and estimators that have come since.
    pub fn tell(&mut self, files: u64) -> Result<(), TransportError> {
        let news = std::mem::replace(&mut self.files, files) != files;
        for publisher in &self.publishers {
            if news {
                publisher.publish(&StateWish::default())?;
            } else {
                publisher.refresh()?;
            }
        }
        Ok(())
    }
}
