use crate::{FormatError, Record};
use mcap::records::{Metadata, op};
use mcap::sans_io::linear_reader::{LinearReadEvent, LinearReader, LinearReaderOptions};
use mcap::{Channel, Schema};
use std::collections::{HashMap, VecDeque};
use std::io::Read;
use std::sync::Arc;

/// A record or chunk that is longer is not believed: it is a damaged length.
const LONGEST: usize = 1 << 28;
/// Magic number at the beginning.
const BEFORE_RECORDS: u64 = mcap::MAGIC.len() as u64;
/// Kind and length before each record.
const BEFORE_BODY: u64 = 9;

/// Reads a recording from its beginning to its end, or to where it is cut.
///
/// A chunk is given whole and with a sound check sum, or not at all.
pub struct Reader<R: Read> {
    source: R,
    inner: LinearReader,
    schemas: HashMap<u16, Arc<Schema<'static>>>,
    channels: HashMap<u16, Arc<Channel<'static>>>,
    ready: VecDeque<Event>,
    sound: u64,
    state: State,
}

enum State {
    Reading,
    Complete,
    Cut(String),
}

/// What a recording holds.
#[derive(Clone, Debug)]
pub enum Event {
    /// What it says about itself.
    Metadata(Metadata),
    /// A message.
    Message(Message),
}

/// A message of a recording, not yet looked into.
#[derive(Clone, Debug)]
pub struct Message {
    /// Topic and schema.
    pub channel: Arc<Channel<'static>>,
    /// The low half of the sample number.
    pub sequence: u32,
    /// When it was recorded, ns since 1970.
    pub log_time: u64,
    /// When it was published, ns since 1970.
    pub publish_time: u64,
    /// Its bytes.
    pub data: Vec<u8>,
}

impl Message {
    /// What the message says; `None` if it is none of ours.
    ///
    /// # Errors
    /// The bytes are not those of its schema.
    pub fn record(&self) -> Result<Option<Record>, FormatError> {
        let Some(schema) = &self.channel.schema else { return Ok(None) };
        Record::decode(&schema.name, &self.data)
            .map_err(|reason| FormatError::Message { topic: self.channel.topic.clone(), reason })
    }
}

impl<R: Read> Reader<R> {
    /// A reader at the beginning.
    pub fn new(source: R) -> Self {
        let options = LinearReaderOptions::default()
            .with_emit_chunks(true)
            // a damaged kind makes a chunk look like a record of a later version, which is passed over
            .with_validate_data_section_crc(true)
            .with_record_length_limit(LONGEST);
        Self {
            source,
            inner: LinearReader::new_with_options(options),
            schemas: HashMap::new(),
            channels: HashMap::new(),
            ready: VecDeque::new(),
            sound: BEFORE_RECORDS,
            state: State::Reading,
        }
    }

    /// Why the recording ends early; `None` if it does not, or has not come to its end.
    pub fn cut(&self) -> Option<&str> {
        match &self.state {
            State::Cut(reason) => Some(reason),
            _ => None,
        }
    }

    /// How many bytes have been read as whole records.
    pub fn sound_bytes(&self) -> u64 {
        self.sound
    }

    /// Takes a record of the file, or of a chunk.
    fn take(&mut self, record: mcap::records::Record<'_>) -> Result<(), String> {
        use mcap::records::Record as R;
        match record {
            R::Schema { header, data } => {
                let (id, name, encoding) = (header.id, header.name, header.encoding);
                let schema = Schema { id, name, encoding, data: data.into_owned().into() };
                self.schemas.insert(id, Arc::new(schema));
            }
            R::Channel(channel) => {
                let schema = self.schemas.get(&channel.schema_id).cloned();
                let (id, topic, message_encoding, metadata) =
                    (channel.id, channel.topic, channel.message_encoding, channel.metadata);
                let channel = Channel { id, topic, schema, message_encoding, metadata };
                self.channels.insert(id, Arc::new(channel));
            }
            R::Message { header, data } => {
                let channel = self.channels.get(&header.channel_id).cloned();
                self.ready.push_back(Event::Message(Message {
                    channel: channel.ok_or_else(|| format!("message of the unknown channel {}", header.channel_id))?,
                    sequence: header.sequence,
                    log_time: header.log_time,
                    publish_time: header.publish_time,
                    data: data.into_owned(),
                }));
            }
            R::Metadata(metadata) => self.ready.push_back(Event::Metadata(metadata)),
            R::Chunk { header, data } => {
                for record in mcap::read::ChunkReader::new(header, &data).map_err(|error| error.to_string())? {
                    self.take(record.map_err(|error| error.to_string())?)?;
                }
            }
            _ => {}
        }
        Ok(())
    }

    /// Reads on until something can be given or the end has come.
    fn read_on(&mut self) -> Result<(), String> {
        while self.ready.is_empty() && matches!(self.state, State::Reading) {
            let event = self.inner.next_event().ok_or("the file ends early")?.map_err(|error| error.to_string())?;
            let (opcode, data) = match event {
                LinearReadEvent::ReadRequest(wanted) => {
                    let read = self.source.read(self.inner.insert(wanted)).map_err(|error| error.to_string())?;
                    self.inner.notify_read(read);
                    continue;
                }
                LinearReadEvent::Record { opcode, data } => (opcode, data),
            };
            let length = BEFORE_BODY + data.len() as u64;
            if opcode == op::DATA_END {
                self.state = State::Complete;
                return Ok(());
            }
            let record = mcap::parse_record(opcode, data).map_err(|error| error.to_string())?.into_owned();
            self.take(record)?;
            self.sound += length;
        }
        Ok(())
    }
}

impl<R: Read> Iterator for Reader<R> {
    type Item = Event;

    fn next(&mut self) -> Option<Event> {
        if let Err(reason) = self.read_on() {
            // what a damaged chunk gave before the damage was met is not to be trusted
            self.ready.clear();
            self.state = State::Cut(reason);
        }
        self.ready.pop_front()
    }
}
