//! Units at the end of a wire.

use crate::text::{MINIMAL, good, read};
use pipeline::configuration::{Configuration, Line, Port, Source};
use std::path::{Path, PathBuf};
use wire::{Angle, Device, Rotation, TimeSource};

/// The smallest configuration with these two sources.
fn with(main: &str, sub: &str) -> String {
    let simulator = "{ kind = \"simulator\" }";
    MINIMAL.replacen(simulator, main, 1).replacen(simulator, sub, 1)
}

const UDP: &str = "{ kind = \"stdbin\", udp = \"127.0.0.1:5000\" }";

fn line(source: &str) -> Line {
    let configuration = good(&with(UDP, source));
    let Source::Line(line) = &configuration.areas[0].source else { panic!("no line") };
    line.clone()
}

#[test]
fn devices_and_ports_can_be_told() {
    let kvh = line("{ kind = \"kvh\", serial = \"/dev/ttyUSB0\" }");
    assert_eq!(kvh.device, Device::Kvh { rotation: Rotation::Delta, angle: Angle::Radians });
    assert_eq!(kvh.port, Port::Serial { path: "/dev/ttyUSB0".into(), baud: 921_600 });
    assert_eq!((kvh.latency_ns, kvh.raw), (0, None));
    let told = "{ kind = \"kvh\", tcp = \"192.168.0.5:4001\", rotation = \"rate\", angle = \"degrees\", latency_ms = 1.25, raw = \"a.raw\" }";
    let kvh = line(told);
    assert_eq!(kvh.device, Device::Kvh { rotation: Rotation::Rate, angle: Angle::Degrees });
    assert_eq!((kvh.port, kvh.latency_ns), (Port::Tcp("192.168.0.5:4001".into()), 1_250_000));
    assert!(kvh.raw.is_some_and(|path: PathBuf| path.is_absolute() && path.ends_with("a.raw")));
    let stim = line("{ kind = \"stim300\", serial = \"/dev/ttyS1\", baud = 460800, accel_range_g = 30 }");
    assert_eq!(stim.device, Device::Stim300 { rotation: Rotation::Rate, force_exponent: 18 });
    assert_eq!((stim.decimation, stim.latency_ns), (1, 0));
    let told = "{ kind = \"stim300\", serial = \"/dev/ttyS1\", low_pass_hz = 131, latency_ms = 0.5, decimation = 20 }";
    assert_eq!((line(told).decimation, line(told).latency_ns), (20, 4_200_000));
    let stdbin = line("{ kind = \"stdbin\", udp = \"[::1]:4\" }");
    assert_eq!((stdbin.device, stdbin.time_source), (Device::Stdbin, TimeSource::Fitted));
    let stdbin = line("{ kind = \"stdbin\", udp = \"[::1]:4\", clock = \"device\", clock_bound_ms = 0.5 }");
    assert_eq!(stdbin.time_source, TimeSource::Device { bound_ns: 500_000 });
}

/// Of one line of the configuration, what is wrong with it.
fn wrong(main: &str, sub: &str) -> String {
    read(&with(main, sub)).expect_err(sub)
}

#[test]
fn what_does_not_go_together_is_told() {
    for (source, told) in [
        ("{ kind = \"kvh\" }", "a source of kind \"kvh\" needs one of the keys `serial`, `udp`, `tcp` and `file`"),
        ("{ kind = \"kvh\", udp = \"1.2.3.4:5\", tcp = \"a:1\" }", "needs one of the keys"),
        (
            "{ kind = \"kvh\", udp = \"localhost\" }",
            "udp = \"localhost\": must be an address and a port, such as 127.0.0.1:5000",
        ),
        ("{ kind = \"kvh\", tcp = \"host\" }", "tcp = \"host\": must be a host and a port"),
        ("{ kind = \"kvh\", udp = \"1.2.3.4:5\", baud = 9600 }", "baud = 9600 goes with `serial` only"),
        ("{ kind = \"kvh\", serial = \"/dev/a\", baud = 5 }", "baud = 5: must be within 1200 to 4147200"),
        (
            "{ kind = \"stdbin\", udp = \"1.2.3.4:5\", rotation = \"rate\" }",
            "a source of kind \"stdbin\" has no `rotation`",
        ),
        (
            "{ kind = \"stim300\", udp = \"1.2.3.4:5\", accel_range_g = 7 }",
            "accel_range_g = 7: must be one of 5, 10, 30, 80",
        ),
        ("{ kind = \"stim300\", udp = \"1.2.3.4:5\", low_pass_hz = 100 }", "must be one of 16, 33, 66, 131, 262"),
        ("{ kind = \"kvh\", udp = \"1.2.3.4:5\", low_pass_hz = 66 }", "a source of kind \"kvh\" has no `low_pass_hz`"),
        ("{ kind = \"kvh\", udp = \"1.2.3.4:5\", decimation = 0 }", "decimation = 0: must be within 1 to 1000"),
        ("{ kind = \"kvh\", udp = \"1.2.3.4:5\", clock = \"device\" }", "a source of kind \"kvh\" tells no UTC"),
        ("{ kind = \"stdbin\", udp = \"1.2.3.4:5\", clock_bound_ms = 1 }", "goes with clock = \"device\" only"),
        ("{ kind = \"kvh\", udp = \"1.2.3.4:5\", path = \"a\" }", "a source of kind \"kvh\" has no `path`"),
        ("{ kind = \"kvh\", udp = \"1.2.3.4:5\", latency_ms = -1 }", "must be within 0 to 1000"),
        ("{ kind = \"kvh\", udp = \"1.2.3.4:5\", serail = \"a\" }", "did you mean `serial`?"),
        ("{ kind = \"kvx\", udp = \"1.2.3.4:5\" }", "did you mean `kvh`?"),
        ("{ kind = \"simulator\" }", "all sources must be devices on wires, and [main] has \"stdbin\""),
        (UDP, "another unit has the same port"),
        ("{ kind = \"kvh\", file = \"nowhere.raw\" }", "cannot read"),
    ] {
        let message = wrong(UDP, source);
        assert!(message.starts_with("ship.toml:") && message.contains(told), "{source}: {message}");
    }
    let message = wrong("{ kind = \"simulator\", udp = \"1.2.3.4:5\" }", "{ kind = \"simulator\" }");
    assert!(message.contains("a source of kind \"simulator\" has no `udp`"), "{message}");
    let told = read(&format!("{}[replay]\npace = 2\n", with(UDP, "{ kind = \"kvh\", udp = \"127.0.0.1:1\" }")));
    assert!(told.is_err_and(|message| message.contains("has no effect with sources of kind \"stdbin\"")));
}

#[test]
fn the_simulation_may_stay() {
    let text = with(UDP, "{ kind = \"kvh\", udp = \"127.0.0.1:5001\" }") + "[simulation]\nspeed_knots = 3\n";
    let configuration = Configuration::parse(Path::new("ship.toml"), &text).expect("sound");
    let simulated = good(&format!("{MINIMAL}[simulation]\nspeed_knots = 3\n"));
    assert_eq!(configuration.scenario(1), simulated.scenario(1));
}
