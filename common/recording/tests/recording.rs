//! Numbers come back to the bit, a file that is cut anywhere gives its whole chunks, and no bytes make the reader fail.
#![allow(clippy::unwrap_used)]

use messages::{Flags, FlexureParams, Health, ImuPair, ImuSample, MainAttitude, Message as Layout, Solution, Truth};
use proptest::prelude::*;
use recording::{About, Adoption, Ending, Event, Reader, Record, Writer};

/// A message of any bits; of those that are not recorded, none are set.
fn filled<M: Layout>(bytes: &[u8]) -> M {
    let mut message = M::default();
    assert!(size_of::<M>() <= bytes.len());
    // SAFETY: every bit pattern is a value of a message, and there are enough bytes.
    unsafe { std::ptr::copy_nonoverlapping(bytes.as_ptr(), (&raw mut message).cast::<u8>(), size_of::<M>()) };
    message.header_mut().end = 0;
    message
}

fn bits<M: Copy>(message: &M) -> &[u8] {
    // SAFETY: messages have no hidden bytes, and the slice lives as long as the message.
    unsafe { std::slice::from_raw_parts(std::ptr::from_ref(message).cast(), size_of::<M>()) }
}

macro_rules! comes_back {
    ($bytes:expr, $variant:ident($type:ident) $(, $left:ident)*) => {{
        let message = $type { $($left: 0,)* ..filled::<$type>($bytes) };
        let record = Record::$variant(message);
        let again = Record::decode(&record.schema_name(), &record.encode()).unwrap();
        let Some(Record::$variant(again)) = again else { panic!("another message") };
        assert_eq!(bits(&message), bits(&again), stringify!($type));
    }};
}

proptest! {
    #[test]
    fn every_number_comes_back_to_the_bit(bytes in prop::collection::vec(any::<u8>(), 1024)) {
        comes_back!(&bytes, Sample(ImuSample));
        comes_back!(&bytes, Attitude(MainAttitude));
        comes_back!(&bytes, Pair(ImuPair));
        comes_back!(&bytes, Parameters(FlexureParams));
        comes_back!(&bytes, Solution(Solution), reserved);
        comes_back!(&bytes, Truth(Truth), reserved);
        comes_back!(&bytes, Health(Health));
        let adoption = Adoption { header: filled::<ImuSample>(&bytes).header, params_id: 3, area: 1, late: 1 };
        let record = Record::from(adoption);
        let again = Record::decode("deckflex.Adoption", &record.encode()).unwrap();
        prop_assert_eq!(Some(record), again);
    }

    #[test]
    fn no_bytes_make_a_message_fail_otherwise_than_by_an_error(bytes in prop::collection::vec(any::<u8>(), 0..600)) {
        for name in ["deckflex.Solution", "deckflex.ImuSample", "deckflex.Health", "deckflex.Adoption"] {
            let _ = Record::decode(name, &bytes);
        }
        prop_assert_eq!(Record::decode("foxglove.Log", &bytes).unwrap(), None);
    }

    #[test]
    fn no_bytes_make_a_file_fail_otherwise_than_by_a_cut(tail in prop::collection::vec(any::<u8>(), 0..400), keep in 0..3000_usize) {
        let whole = recorded(8, 3);
        let mut damaged = whole[..keep.min(whole.len())].to_vec();
        damaged.extend(&tail);
        let mut reader = Reader::new(damaged.as_slice());
        let numbers = numbers(&mut reader);
        prop_assert!(numbers.iter().copied().eq(0..numbers.len() as u64));
    }
}

fn sample(number: u64) -> Record {
    let mut sample = ImuSample { ordinal: number, flags: Flags::SPIKE, ..ImuSample::default() };
    sample.header.sequence = number;
    sample.dtheta = [number as f64 / 3.0, f64::MIN_POSITIVE, -0.0];
    sample.into()
}

fn about() -> About {
    About {
        version: "1".into(),
        run_id: 7,
        part: 2,
        from_the_start: true,
        path: "a.toml".into(),
        configuration: "x = 1\n".into(),
    }
}

const ENDING: Ending = Ending { end_of_run: true, dropped: 4, lost: 5 };

/// So many chunks of so many samples.
fn recorded(chunks: u64, samples: u64) -> Vec<u8> {
    let mut writer = Writer::new(Vec::new(), &about()).unwrap();
    for chunk in 0..chunks {
        for number in chunk * samples..(chunk + 1) * samples {
            writer.write("main/imu", 1000 + number, &sample(number)).unwrap();
        }
        writer.flush().unwrap();
    }
    writer.finish(&ENDING).unwrap()
}

/// The sample numbers that a reader gives; each sample must be the one that was written.
fn numbers(reader: &mut Reader<&[u8]>) -> Vec<u64> {
    let mut numbers = Vec::new();
    for event in reader {
        let Event::Message(message) = event else { continue };
        let record = message.record().unwrap().unwrap();
        let number = record.header().sequence;
        assert_eq!(record, sample(number));
        assert_eq!((message.channel.topic.as_str(), message.log_time), ("main/imu", 1000 + number));
        numbers.push(number);
    }
    numbers
}

#[test]
fn a_recording_says_what_it_is() {
    let file = recorded(2, 3);
    let mut reader = Reader::new(file.as_slice());
    let events: Vec<Event> = reader.by_ref().collect();
    assert_eq!(reader.cut(), None);
    let Event::Metadata(first) = &events[0] else { panic!("not at the beginning") };
    assert_eq!(About::from_metadata(&first.name, &first.metadata), Some(about()));
    let Event::Metadata(last) = &events[events.len() - 1] else { panic!("not at the end") };
    assert_eq!(Ending::from_metadata(&last.name, &last.metadata), Some(ENDING));
    assert_eq!(About::from_metadata(&last.name, &last.metadata), None);
    assert_eq!(events.len(), 2 + 6);
}

/// Wherever it is cut: all whole chunks come, nothing else, and how far the file is sound is told.
#[test]
fn a_cut_recording_gives_its_whole_chunks() {
    let (chunks, samples) = (5, 4);
    let file = recorded(chunks, samples);
    let mut whole = 0;
    for length in 0..file.len() {
        let mut reader = Reader::new(&file[..length]);
        let numbers = numbers(&mut reader);
        assert!(numbers.iter().copied().eq(0..numbers.len() as u64), "{length}: {numbers:?}");
        assert_eq!(numbers.len() as u64 % samples, 0, "{length}: a part of a chunk");
        assert!(numbers.len() >= whole, "{length}: a longer file gives less");
        whole = numbers.len();
        assert!(reader.sound_bytes() <= length.max(8) as u64);
        // from the end of the data on only the index is missing
        assert!(reader.cut().is_some() || whole as u64 == chunks * samples, "{length}: the cut is not told");
    }
    assert_eq!(whole as u64, chunks * samples);
}

/// A damaged byte costs messages and is told, and never makes a wrong number.
#[test]
fn a_damaged_recording_is_not_believed() {
    let file = recorded(5, 4);
    let end_of_data = Reader::new(file.as_slice()).by_ref().count();
    for place in 8..file.len() {
        let mut damaged = file.clone();
        damaged[place] ^= 0x10;
        let mut reader = Reader::new(damaged.as_slice());
        let mut events = 0;
        for event in reader.by_ref() {
            events += 1;
            let Event::Message(message) = event else { continue };
            let record = message.record().unwrap().unwrap();
            assert_eq!(record, sample(record.header().sequence), "damaged at {place}");
        }
        assert!(events == end_of_data || reader.cut().is_some(), "damaged at {place}: {events} and not told");
    }
}

#[test]
fn a_copy_is_the_same() {
    let file = recorded(3, 4);
    let mut reader = Reader::new(file.as_slice());
    let mut writer = Writer::copying(Vec::new()).unwrap();
    for event in reader.by_ref() {
        match event {
            Event::Metadata(metadata) => writer.metadata(&metadata).unwrap(),
            Event::Message(message) => writer.copy(&message).unwrap(),
        }
    }
    let copy = writer.finish_as_is().unwrap();
    assert_eq!(numbers(&mut Reader::new(copy.as_slice())), numbers(&mut Reader::new(file.as_slice())));
}

#[test]
fn an_abandoned_recording_holds_what_was_flushed() {
    let mut writer = Writer::new(Vec::new(), &about()).unwrap();
    writer.write("main/imu", 1000, &sample(0)).unwrap();
    assert!(writer.held() > 0);
    writer.flush().unwrap();
    assert_eq!(writer.held(), 0);
    writer.write("main/imu", 1001, &sample(1)).unwrap();
    let file = writer.abandon();
    let mut reader = Reader::new(file.as_slice());
    assert_eq!(numbers(&mut reader), [0]);
    assert!(reader.cut().is_some());
}
