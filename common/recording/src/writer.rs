use crate::{About, Ending, FormatError, Message, Record};
use mcap::records::MessageHeader;
use mcap::write::NoSeek;
use mcap::{WriteOptions, records::Metadata};
use std::collections::{BTreeMap, HashMap};
use std::io::Write;

/// Writes a recording. Whatever has been flushed can be read, though nothing may follow; what has not is in memory only.
pub struct Writer<W: Write> {
    inner: mcap::Writer<NoSeek<W>>,
    channels: HashMap<String, u16>,
    held: u64,
}

impl<W: Write> Writer<W> {
    /// Begins a recording with what it says about itself.
    ///
    /// # Errors
    /// The output cannot be written.
    pub fn new(out: W, about: &About) -> Result<Self, FormatError> {
        let mut writer = Self::copying(out)?;
        writer.metadata(&about.metadata())?;
        Ok(writer)
    }

    /// Begins a recording that takes over another one's messages and metadata.
    ///
    /// # Errors
    /// The output cannot be written.
    pub fn copying(out: W) -> Result<Self, FormatError> {
        let options = WriteOptions::new()
            .library(concat!("deckflex ", env!("CARGO_PKG_VERSION")))
            // a chunk ends with a flush, and until then it is no part of the file, which so consists of whole ones
            .chunk_size(None)
            .disable_seeking(true);
        Ok(Self { inner: options.create(NoSeek::new(out))?, channels: HashMap::new(), held: 0 })
    }

    /// Adds a message of a topic, `time_ns` since 1970.
    ///
    /// # Errors
    /// The output cannot be written.
    pub fn write(&mut self, topic: &str, time_ns: u64, record: &Record) -> Result<(), FormatError> {
        let channel_id = match self.channels.get(topic) {
            Some(id) => *id,
            None => self.channel(topic, record)?,
        };
        let data = record.encode();
        let sequence = record.header().sequence as u32;
        let header = MessageHeader { channel_id, sequence, log_time: time_ns, publish_time: time_ns };
        self.inner.write_to_known_channel(&header, &data)?;
        self.held += data.len() as u64;
        Ok(())
    }

    fn channel(&mut self, topic: &str, record: &Record) -> Result<u16, FormatError> {
        let schema = self.inner.add_schema(&record.schema_name(), "protobuf", &record.schema())?;
        let id = self.inner.add_channel(schema, topic, "protobuf", &BTreeMap::new())?;
        self.channels.insert(topic.to_owned(), id);
        Ok(id)
    }

    /// Adds another recording's message as it is.
    ///
    /// # Errors
    /// The output cannot be written.
    pub fn copy(&mut self, message: &Message) -> Result<(), FormatError> {
        let copy = mcap::Message {
            channel: message.channel.clone(),
            sequence: message.sequence,
            log_time: message.log_time,
            publish_time: message.publish_time,
            data: message.data.as_slice().into(),
        };
        self.inner.write(&copy)?;
        self.held += message.data.len() as u64;
        Ok(())
    }

    /// Adds metadata, and flushes what came before.
    ///
    /// # Errors
    /// The output cannot be written.
    pub fn metadata(&mut self, metadata: &Metadata) -> Result<(), FormatError> {
        Ok(self.inner.write_metadata(metadata)?)
    }

    /// How many bytes of messages have been added since the last flush.
    pub fn held(&self) -> u64 {
        self.held
    }

    /// Ends the chunk and brings it to the output.
    ///
    /// # Errors
    /// The output cannot be written; the recording then has to be abandoned.
    pub fn flush(&mut self) -> Result<(), FormatError> {
        self.held = 0;
        Ok(self.inner.flush()?)
    }

    /// Completes the recording with its index and with what it says about itself at its end.
    ///
    /// # Errors
    /// The output cannot be written.
    pub fn finish(mut self, ending: &Ending) -> Result<W, FormatError> {
        self.metadata(&ending.metadata())?;
        self.finish_as_is()
    }

    /// Completes the recording with its index.
    ///
    /// # Errors
    /// The output cannot be written.
    pub fn finish_as_is(mut self) -> Result<W, FormatError> {
        self.inner.finish()?;
        Ok(self.abandon())
    }

    /// Leaves the recording as it is, without what has not been flushed and without its index.
    pub fn abandon(self) -> W {
        self.inner.into_inner().into_inner()
    }
}
