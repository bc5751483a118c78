//! Where telegrams go, and what a mistake there is told. The tables begin at line 9.

use crate::text::{good, message_with, read_with};
use pipeline::configuration::{Destination, Telegrams};
use std::path::Path;
use telegrams::{Sentence, Talker};

const UDP: &str = "to = { kind = \"udp\", address = \"127.0.0.1:60001\" }";

/// An output of the minimal configuration; its keys begin at line 10.
fn output(keys: &str) -> String {
    format!("[[output]]\n{keys}")
}

/// The message about an output in which everything but `keys` is right.
fn told(keys: &str) -> String {
    message_with(&output(&format!("area = \"radar\"\n{keys}"))).replace("ship.toml:", "")
}

#[test]
fn the_shipped_configuration_is_read() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../config/outputs.toml");
    let text = std::fs::read_to_string(path).expect("the shipped configuration");
    let configuration = good(&text);
    let [text, binary] = &configuration.outputs[..] else { panic!("two outputs") };
    assert_eq!(text.to.to_string(), "udp 127.0.0.1:60001");
    let sentences = vec![Sentence::Hdt, Sentence::Rot, Sentence::Pashr, Sentence::Xdr];
    assert_eq!((&text.telegrams, text.rate_hz, text.decimals), (&Telegrams::Sentences(sentences), 10.0, 3));
    assert_eq!(
        (&binary.telegrams, binary.rate_hz, binary.extrapolate_s, binary.silence_s),
        (&Telegrams::Kmb, 100.0, 0.01, 0.2)
    );
    let limits = configuration.areas[0].alarm.expect("limits");
    assert_eq!((limits.hold_s, limits.invalid_s), (2.0, Some(5.0)));
    assert!((limits.range.expect("a range")[2] - 3.0 * frames::unit::ARCMIN).abs() < 1e-12);
    // what is commented out would work as well
    let uncommented = std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("../../config/outputs.toml"));
    let uncommented: Vec<String> = uncommented
        .expect("the shipped configuration")
        .lines()
        .map(|line| match line.strip_prefix("# ") {
            Some(rest) if ["[[output]]", "area =", "to =", "sentences ="].iter().any(|key| rest.starts_with(key)) => {
                rest.into()
            }
            _ => line.to_owned(),
        })
        .collect();
    assert_eq!(good(&uncommented.join("\n")).outputs.len(), 4);
}

#[test]
fn what_is_left_out_has_a_sensible_value() {
    let read = read_with(&output(&format!("area = \"radar\"\n{UDP}\nsentences = [\"HDT\"]"))).expect("a good output");
    let output = &read.outputs[0];
    assert_eq!(output.style().talker, Talker::INTEGRATED);
    assert_eq!((output.rate_hz, output.decimals, output.extrapolate_s, output.silence_s), (10.0, 2, 0.0, 0.5));
    let Destination::Udp { ttl: None, interface: None, .. } = output.to else { panic!("{:?}", output.to) };
}

#[test]
fn a_value_that_is_not_allowed_is_told_with_what_is() {
    for (keys, message) in [
        (
            "to = { kind = \"udp\", address = \"radar:60001\" }",
            "11: output[0].to.address = \"radar:60001\": must be an address with a port of 1 to 65535, such as \"192.168.0.20:4001\"",
        ),
        (
            "to = { kind = \"udp\", address = \"127.0.0.1:1\", ttl = 0 }",
            "11: output[0].to.ttl = 0: must be within 1 to 255",
        ),
        (
            "to = { kind = \"serial\", device = \"/dev/ttyS0\", baud = 38401 }",
            "11: output[0].to.baud = 38401: must be one of 4800, 9600, 19200, 38400, 57600, 115200, 230400, 460800, 921600",
        ),
        (
            "to = { kind = \"serial\", device = \"/dev/ttyS0\" }",
            "11: output[0].to: a destination of kind \"serial\" needs the keys `device` and `baud` and has no others",
        ),
        (
            "to = { kind = \"udp\", device = \"/dev/ttyS0\" }",
            "11: output[0].to: a destination of kind \"udp\" needs the key `address` and may have `ttl` and `interface`",
        ),
        ("to = { kind = \"pipe\" }", "11: output[0].to.kind = \"pipe\": must be one of \"udp\", \"serial\""),
    ] {
        assert_eq!(told(keys), message);
    }
    for (key, message) in [
        ("talker = \"PA\"", "talker = \"PA\": must be two capital letters or digits and not begin with P"),
        ("decimals = 6", "decimals = 6: must be within 1 to 5"),
        ("rate_hz = 0", "rate_hz = 0: must be within 0.1 to 200"),
        ("extrapolate_ms = 51", "extrapolate_ms = 51: must be within 0 to 50"),
        ("silence_ms = 1", "silence_ms = 1: must be within 20 to 60000"),
    ] {
        assert_eq!(told(&format!("{UDP}\nsentences = [\"HDT\"]\n{key}")), format!("13: output[0].{message}"));
    }
    for (sentences, message) in [
        ("[\"GGA\"]", "must be some of HDT, ROT, PASHR, PRDID, PHTRO, XDR, or KMB alone"),
        ("[]", "must be some of HDT, ROT, PASHR, PRDID, PHTRO, XDR, or KMB alone"),
        ("[\"HDT\", \"KMB\"]", "KMB is binary and must be alone: give it a destination of its own"),
    ] {
        assert_eq!(told(&format!("{UDP}\nsentences = {sentences}")), format!("12: output[0].sentences: {message}"));
    }
}

#[test]
fn keys_that_contradict_each_other_are_told() {
    assert_eq!(
        message_with(&output(&format!("area = \"mast\"\n{UDP}\nsentences = [\"HDT\"]"))),
        "ship.toml:10: output[0].area = \"mast\": must be the name of an area: \"radar\""
    );
    let hdt = "sentences = [\"HDT\"]";
    assert_eq!(
        told(&format!("{UDP}\n{hdt}\nrate_hz = 120")),
        "13: output[0].rate_hz = 120: must not be above the samples' rate_hz = 100"
    );
    assert_eq!(
        told(&format!("to = {{ kind = \"udp\", address = \"[::1]:9\", interface = \"127.0.0.1\" }}\n{hdt}")),
        "11: output[0].to.interface = \"127.0.0.1\": goes with IPv4 addresses only"
    );
    let serial = |baud: u32| format!("to = {{ kind = \"serial\", device = \"/dev/ttyS0\", baud = {baud} }}");
    assert_eq!(
        told(&format!("{}\nsentences = [\"PASHR\", \"XDR\"]\nrate_hz = 20", serial(38_400))),
        "11: output[0].to.baud = 38400: 212 bytes, 20 times a second, need up to 42400 baud: fewer sentences, a lower rate_hz or a faster line"
    );
    let one = format!("[[output]]\narea = \"radar\"\n{}\n{hdt}\n", serial(9600));
    assert_eq!(
        message_with(&format!("{one}{one}")),
        "ship.toml:15: output[1].to.device = \"/dev/ttyS0\": output[0] has the same device"
    );
}

#[test]
fn limits_are_told_with_their_range() {
    assert_eq!(
        message_with("[area.alarm]\nrange_arcmin = [1, 1]"),
        "ship.toml:10: area[0].alarm.range_arcmin: expected 3 elements, found 2"
    );
    assert_eq!(
        message_with("[area.alarm]\ninvalid_s = 0"),
        "ship.toml:10: area[0].alarm.invalid_s = 0: must be within 0.1 to 86400"
    );
}
