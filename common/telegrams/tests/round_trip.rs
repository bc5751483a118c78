//! Telegrams read back: sentences by a parser that is not ours, the binary by its published offsets.
#![allow(clippy::unwrap_used)]

use frames::{Euler, unit::DEGREE};
use nmea::{ParseResult, parse_nmea_sentence, parse_str, sentences::HdtData};
use rand::{RngExt, SeedableRng};
use std::f64::consts::TAU;
use telegrams::{Attitude, Axes, Deformation, Report, Sentence, Style, Talker, encode_kmb};

const STYLE: Style = Style { talker: Talker::INTEGRATED, decimals: 4 };

/// Reports of all attitudes and deformations, some of them without one or the other.
fn reports() -> impl Iterator<Item = Report> {
    let mut random = rand_pcg::Pcg64::seed_from_u64(1);
    (0..2000).map(move |k| {
        let mut within = |end: f64| random.random_range(-end..=end);
        let angles = Euler { roll: within(3.0), pitch: within(1.3), heading: within(TAU / 2.0).rem_euclid(TAU) };
        let mut axes = |end| Axes { roll: within(end), pitch: within(end), heading: within(end) };
        let rate = axes(0.5);
        let sigma = axes(0.01);
        let sigma = Axes { roll: sigma.roll.abs(), pitch: sigma.pitch.abs(), heading: sigma.heading.abs() };
        let deformation =
            Deformation { angles: [within(0.1), within(1.0), within(3.0)], range: [within(0.1).abs(); 3] };
        Report {
            utc_ns: 1_700_000_000_000_000_000 + k * 10_000_123,
            attitude: (k % 10 != 3).then_some(Attitude { angles, sigma, rate }),
            deformation: (k % 10 != 7).then_some(deformation),
            zero: (k % 4 == 1).then_some([within(0.09), within(0.09), within(0.09)]),
            reduced: k % 3 == 0,
        }
    })
}

fn written(sentence: Sentence, report: &Report) -> String {
    let mut text = String::new();
    sentence.write(report, &STYLE, &mut text);
    text
}

/// Kind and fields of a line by the foreign parser, which also checks the sum.
fn fields(line: &str) -> (String, Vec<String>) {
    let parsed = parse_nmea_sentence(line).unwrap();
    assert_eq!(parsed.checksum, parsed.calc_checksum(), "{line}");
    (parsed.message_id.as_str().to_owned(), parsed.data.split(',').map(str::to_owned).collect())
}

#[test]
fn headings_come_back() {
    for report in reports() {
        let text = written(Sentence::Hdt, &report);
        let Ok(ParseResult::HDT(HdtData { heading })) = parse_str(text.trim_end()) else { panic!("{text}") };
        assert_eq!(heading.is_some(), report.attitude.is_some());
        if let (Some(read), Some(sent)) = (heading, report.attitude) {
            let off = (f64::from(read) - sent.angles.heading / DEGREE + 180.0).rem_euclid(360.0) - 180.0;
            assert!(off.abs() < 1e-4, "{text}");
        }
    }
}

#[test]
fn rates_of_turn_come_back() {
    for report in reports() {
        let (kind, fields) = fields(written(Sentence::Rot, &report).trim_end());
        assert_eq!(kind, "ROT");
        match report.attitude {
            Some(sent) => {
                assert_eq!(fields[1], "A");
                let off = fields[0].parse::<f64>().unwrap() - sent.rate.heading / DEGREE * 60.0;
                assert!(off.abs() <= 0.51e-4);
            }
            None => assert_eq!(fields, ["", "V"]),
        }
    }
}

#[test]
fn deformations_come_back_to_a_fraction_of_an_arcsecond() {
    for report in reports() {
        let text = written(Sentence::Xdr, &report);
        assert!(text.len() <= Sentence::Xdr.longest(STYLE.decimals, report.zero.is_some()), "{text}");
        let lines: Vec<&str> = text.lines().collect();
        assert_eq!(lines.len(), if report.zero.is_some() { 3 } else { 2 });
        for (line, name) in lines.iter().zip(["DEF", "RNG", "ZER"]) {
            let (kind, fields) = fields(line);
            assert_eq!((kind.as_str(), fields.len()), ("XDR", 12));
            for (i, transducer) in fields.chunks(4).enumerate() {
                assert_eq!([&transducer[0], &transducer[2]], ["A", "D"]);
                assert_eq!(transducer[3], format!("{name}{}", ["X", "Y", "Z"][i]));
                let sent = match name {
                    "DEF" => report.deformation.map(|sent| sent.angles[i]),
                    "RNG" => report.deformation.map(|sent| sent.range[i]),
                    _ => report.zero.map(|zero| zero[i]),
                };
                let Some(sent) = sent else {
                    assert_eq!(transducer[1], "");
                    continue;
                };
                assert!((transducer[1].parse::<f64>().unwrap() - sent / DEGREE).abs() <= 0.51e-5, "{line}");
            }
        }
    }
}

#[test]
fn a_changed_letter_does_not_pass() {
    let report = reports().next().unwrap();
    let line = written(Sentence::Hdt, &report);
    for i in 7..line.find(",T").unwrap() {
        let mut bytes = line.trim_end().to_owned().into_bytes();
        bytes[i] ^= 1;
        let changed = String::from_utf8(bytes).unwrap();
        assert!(parse_str(&changed).is_err(), "{changed}");
    }
}

#[test]
fn the_binary_comes_back_by_its_offsets() {
    for report in reports() {
        let bytes = encode_kmb(&report);
        let word = |at: usize| u32::from_le_bytes(bytes[at..at + 4].try_into().unwrap());
        let number = |at: usize| f64::from(f32::from_le_bytes(bytes[at..at + 4].try_into().unwrap()));
        assert_eq!((bytes.len(), &bytes[..8]), (132, &b"#KMB\x84\x00\x01\x00"[..]));
        assert_eq!(i64::from(word(8)) * 1_000_000_000 + i64::from(word(12)), report.utc_ns);
        let status = word(16);
        assert_eq!(status & 0b11_1001, 0b11_1001, "position, heave, acceleration: never known");
        assert_eq!(status >> 1 & 0b11, if report.attitude.is_some() { 0 } else { 0b11 });
        let reduced = report.reduced && report.attitude.is_some();
        assert_eq!(status >> 16, if reduced { 0b110 } else { 0 });
        assert_eq!([80, 84, 88, 104].map(number), [-1.0; 4], "errors of what is not known");
        assert!(bytes[20..40].iter().chain(&bytes[52..56]).chain(&bytes[68..80]).all(|b| *b == 0));
        assert!(bytes[108..].iter().all(|b| *b == 0));
        let Some(Attitude { angles, sigma, rate }) = report.attitude else {
            assert_eq!([92, 96, 100].map(number), [-1.0; 3]);
            continue;
        };
        let sent = [
            (40, angles.roll),
            (44, angles.pitch),
            (48, angles.heading),
            (56, rate.roll),
            (60, rate.pitch),
            (64, rate.heading),
            (92, sigma.roll),
            (96, sigma.pitch),
            (100, sigma.heading),
        ];
        for (at, radians) in sent {
            assert!((number(at) * DEGREE - radians).abs() <= 1e-7 * radians.abs().max(1e-9), "offset {at}");
        }
    }
}
