//! Published examples of the sentences, and what invalid ones look like.
#![allow(clippy::unwrap_used)]

use frames::{Euler, unit::DEGREE};
use telegrams::{Attitude, Axes, Deformation, Report, Sentence, Style, Talker, encode_kmb};

/// 20 September 2023, so many seconds of the day.
fn utc_ns(hour: i64, minute: i64, second: f64) -> i64 {
    1_695_168_000_000_000_000 + (hour * 3600 + minute * 60) * 1_000_000_000 + (second * 1e9).round() as i64
}

fn axes(roll: f64, pitch: f64, heading: f64) -> Axes {
    Axes { roll: roll * DEGREE, pitch: pitch * DEGREE, heading: heading * DEGREE }
}

/// Degrees and degrees a second.
fn report(roll: f64, pitch: f64, heading: f64) -> Report {
    let angles = Euler { roll: roll * DEGREE, pitch: pitch * DEGREE, heading: heading * DEGREE };
    let attitude = Attitude { angles, sigma: axes(0.01, 0.02, 0.03), rate: Axes::default() };
    Report { attitude: Some(attitude), ..Report::default() }
}

fn turning(a_minute: f64) -> Report {
    let mut report = report(0.0, 0.0, 0.0);
    report.attitude.as_mut().unwrap().rate.heading = a_minute * DEGREE / 60.0;
    report
}

fn written(sentence: Sentence, talker: &str, decimals: usize, report: &Report) -> String {
    let mut text = String::new();
    sentence.write(report, &Style { talker: Talker::new(talker).unwrap(), decimals }, &mut text);
    assert!(text.len() <= sentence.longest(decimals, report.zero.is_some()), "{} bytes: {text}", text.len());
    text
}

/// The sum of an example as its maker printed it, worked out here on its own.
fn assert_sum(line: &str) {
    let (body, sum) = line.trim_end().strip_prefix('$').unwrap().split_once('*').unwrap();
    let computed = body.bytes().reduce(|a, b| a ^ b).unwrap();
    assert_eq!(format!("{computed:02X}"), sum, "{line}");
}

#[test]
fn heading_and_rate_of_turn_are_the_published_ones() {
    assert_eq!(written(Sentence::Hdt, "GP", 2, &report(0.0, 0.0, 191.94)), "$GPHDT,191.94,T*01\r\n");
    assert_eq!(written(Sentence::Rot, "GP", 2, &turning(31.61)), "$GPROT,31.61,A*34\r\n");
    assert!(written(Sentence::Rot, "GP", 2, &turning(-31.61)).starts_with("$GPROT,-31.61,A*"));
}

/// NovAtel's example, but for the heave, which is not known here, and for the width that SBG and Applanix give the angles.
#[test]
fn pashr_is_the_published_one() {
    let published = "$PASHR,163029.000,158.09,T,-0.30,+0.31,+0.01,0.029,0.029,0.059,1,1*3B";
    assert_sum(published);
    let mut report = report(-0.30, 0.31, 158.09);
    report.utc_ns = utc_ns(16, 30, 29.0);
    report.attitude.as_mut().unwrap().sigma = axes(0.029, 0.029, 0.059);
    let ours = written(Sentence::Pashr, "IN", 2, &report);
    assert_sum(&ours);
    let ours: Vec<&str> = ours.split(['*', ',']).collect();
    for (i, field) in published.split(['*', ',']).enumerate().filter(|(i, _)| ![6, 12].contains(i)) {
        match (field.parse::<f64>(), ours[i].parse::<f64>()) {
            (Ok(theirs), Ok(ours)) => assert_eq!(theirs, ours, "field {i}"),
            _ => assert_eq!(field, ours[i], "field {i}"),
        }
    }
    assert_eq!(ours[6], "");
}

/// SBG's example to the letter, but for the time, which has one decimal more here, and the heave.
#[test]
fn pashr_is_as_wide_as_published() {
    let published = "$PASHR,123816.80,312.95,T,-000.83,-000.42,-000.01,0.234,0.224,0.298,1,0*09";
    assert_sum(published);
    let mut report = report(-0.83, -0.42, 312.95);
    report.utc_ns = utc_ns(12, 38, 16.8);
    report.attitude.as_mut().unwrap().sigma = axes(0.234, 0.224, 0.298);
    let ours = written(Sentence::Pashr, "IN", 2, &report);
    let like_published = ours.replace("16.800,", "16.80,").replace(",,0.234", ",-000.01,0.234").replace("1,1*", "1,0*");
    assert_eq!(like_published[..like_published.find('*').unwrap()], published[..published.find('*').unwrap()]);
}

#[test]
fn prdid_and_phtro_are_the_published_ones() {
    // the published heading is beyond a full turn
    assert_sum("$PRDID,-012.39,+002.14,366.91*7A");
    let ours = written(Sentence::Prdid, "IN", 2, &report(2.14, -12.39, 6.91));
    assert_eq!(ours.split('*').next().unwrap(), "$PRDID,-012.39,+002.14,006.91");
    assert_sum(&ours);
    assert_eq!(written(Sentence::Phtro, "IN", 2, &report(0.22, -0.03, 0.0)), "$PHTRO,0.03,P,0.22,T*56\r\n");
    let other_side = written(Sentence::Phtro, "IN", 2, &report(-0.22, 0.03, 0.0));
    assert!(other_side.starts_with("$PHTRO,0.03,M,0.22,B*"), "{other_side}");
}

#[test]
fn invalid_is_said_as_each_format_says_it() {
    let invalid = Report { utc_ns: utc_ns(1, 2, 3.0), ..Report::default() };
    assert_eq!(written(Sentence::Hdt, "GP", 2, &invalid), "$GPHDT,,T*1B\r\n");
    assert_eq!(written(Sentence::Rot, "GP", 2, &invalid), "$GPROT,,V*08\r\n");
    assert_eq!(written(Sentence::Pashr, "GP", 2, &invalid), "$PASHR,,,T,,,,,,,0,1*21\r\n");
    assert_eq!(written(Sentence::Prdid, "GP", 2, &invalid).split('*').next(), Some("$PRDID,,,"));
    assert_eq!(written(Sentence::Phtro, "GP", 2, &invalid).split('*').next(), Some("$PHTRO,,,,"));
    let xdr = written(Sentence::Xdr, "YX", 2, &invalid);
    assert!(xdr.starts_with("$YXXDR,A,,D,DEFX,A,,D,DEFY,A,,D,DEFZ*"), "{xdr}");
    let status = u32::from_le_bytes(encode_kmb(&invalid)[16..20].try_into().unwrap());
    assert_eq!(status, 0b11_1111, "nothing in it is valid");
}

#[test]
fn no_number_is_a_full_turn_or_less_than_nothing() {
    assert!(written(Sentence::Hdt, "HE", 2, &report(0.0, 0.0, 359.9951)).starts_with("$HEHDT,0.00,T"));
    assert!(written(Sentence::Hdt, "HE", 3, &report(0.0, 0.0, 359.9951)).starts_with("$HEHDT,359.995,T"));
    let level = written(Sentence::Prdid, "HE", 2, &report(-0.001, -0.001, 0.0));
    assert!(level.starts_with("$PRDID,+000.00,+000.00,000.00*"), "{level}");
    assert!(written(Sentence::Phtro, "HE", 2, &report(-0.001, -0.001, 0.0)).starts_with("$PHTRO,0.00,M,0.00,T*"));
    let heading = f32::from_le_bytes(encode_kmb(&report(0.0, 0.0, 359.999_999_9))[48..52].try_into().unwrap());
    assert_eq!(heading, 0.0);
}

/// A sigma is rounded up: five seconds of arc must not read as none.
#[test]
fn a_small_sigma_does_not_read_as_zero() {
    let mut report = report(0.0, 0.0, 0.0);
    report.attitude.as_mut().unwrap().sigma = axes(1e-5, 1.4e-3, 400.0);
    let text = written(Sentence::Pashr, "IN", 2, &report);
    assert!(text.contains(",0.001,0.002,99.999,1,1*"), "{text}");
}

#[test]
fn nothing_is_longer_than_the_standard_allows() {
    let mut widest = report(-179.987_654_3, -79.987_654_3, 359.987_654_3);
    let attitude = widest.attitude.as_mut().unwrap();
    attitude.sigma = axes(99.0, 99.0, 99.0);
    attitude.rate = axes(-1e9, -1e9, -1e9);
    widest.deformation = Some(Deformation { angles: [-180.0 * DEGREE; 3], range: [180.0 * DEGREE; 3] });
    for decimals in 1..=5 {
        for sentence in Sentence::ALL {
            let text = written(sentence, "IN", decimals, &widest);
            for line in text.lines() {
                assert!(line.len() + 2 <= 82, "{} characters: {line}", line.len() + 2);
                assert_sum(line);
            }
        }
    }
}

#[test]
fn talkers_are_two_capitals() {
    for good in ["IN", "HE", "GP", "U3"] {
        assert!(Talker::new(good).is_some(), "{good}");
    }
    for bad in ["", "I", "INS", "in", "P1", "PA", "I,", "Ä"] {
        assert!(Talker::new(bad).is_none(), "{bad}");
    }
}
