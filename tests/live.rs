//! A viewer of a running launch, by a client that is not the library's.
#![allow(clippy::unwrap_used)]

mod common;

use common::launch::{Launch, one_at_a_time, send};
use common::{Place, demo};
use libc::{SIGKILL, SIGTERM};
use messages::Solution;
use pipeline::solution_file::SolutionFile;
use recording::Record;
use serde_json::{Value, json};
use std::collections::HashMap;
use std::fs::{self, File};
use std::io::{Read, Write};
use std::net::TcpStream;
use std::process::{Child, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

/// `deckflex live`; dropped, it is killed.
struct Server {
    child: Child,
}

impl Server {
    fn start(place: &Place) -> (Self, String) {
        let errors = place.path("live.txt");
        let mut command = place.deckflex();
        command.args(["live", "--listen", "127.0.0.1:0"]).stdin(Stdio::null()).stdout(Stdio::piped());
        let child = command.stderr(File::create(&errors).unwrap()).spawn().unwrap();
        let server = Self { child };
        let start = Instant::now();
        loop {
            let said = fs::read_to_string(&errors).unwrap();
            if let Some((_, rest)) = said.split_once("listening on ws://")
                && let Some((address, _)) = rest.split_once('\n')
            {
                return (server, address.to_owned());
            }
            assert!(start.elapsed() < Duration::from_secs(60), "{said}");
            sleep(Duration::from_millis(5));
        }
    }
}

impl Drop for Server {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// What a server sends.
enum Frame {
    Text(Value),
    Data { subscription: u64, bytes: Vec<u8> },
}

/// A WebSocket with what the test needs of it.
struct Viewer {
    stream: TcpStream,
    /// By number, the names of the schemas of the topics that were subscribed to.
    schemas: HashMap<u64, String>,
}

impl Viewer {
    fn connect(address: &str) -> Self {
        let mut stream = TcpStream::connect(address).unwrap();
        stream.set_read_timeout(Some(Duration::from_secs(60))).unwrap();
        write!(
            stream,
            "GET / HTTP/1.1\r\nHost: {address}\r\nUpgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Version: 13\r\n\
             Sec-WebSocket-Key: AAAAAAAAAAAAAAAAAAAAAA==\r\nSec-WebSocket-Protocol: foxglove.sdk.v1\r\n\r\n"
        )
        .unwrap();
        let mut answer = Vec::new();
        while !answer.ends_with(b"\r\n\r\n") {
            let mut byte = [0];
            stream.read_exact(&mut byte).unwrap();
            answer.push(byte[0]);
        }
        assert!(answer.starts_with(b"HTTP/1.1 101"), "{}", String::from_utf8_lossy(&answer));
        Self { stream, schemas: HashMap::new() }
    }

    fn take<const N: usize>(&mut self) -> [u8; N] {
        let mut bytes = [0; N];
        self.stream.read_exact(&mut bytes).unwrap();
        bytes
    }

    fn next(&mut self) -> Frame {
        let [kind, length] = self.take();
        let length = match length {
            126 => u64::from(u16::from_be_bytes(self.take())),
            127 => u64::from_be_bytes(self.take()),
            short => u64::from(short),
        };
        let mut body = vec![0; length as usize];
        self.stream.read_exact(&mut body).unwrap();
        match (kind & 0xf, body.first()) {
            (1, _) => Frame::Text(serde_json::from_slice(&body).unwrap()),
            (2, Some(1)) => {
                let subscription = u64::from(u32::from_le_bytes(body[1..5].try_into().unwrap()));
                Frame::Data { subscription, bytes: body[13..].to_vec() }
            }
            _ => panic!("a frame of kind {kind:#x}: {body:?}"),
        }
    }

    fn say(&mut self, value: &Value) {
        let text = value.to_string();
        // masked by zeros
        let mut frame = vec![0x81, 0x80 | 126];
        frame.extend_from_slice(&(text.len() as u16).to_be_bytes());
        frame.extend_from_slice(&[0; 4]);
        frame.extend_from_slice(text.as_bytes());
        self.stream.write_all(&frame).unwrap();
    }

    /// The next solution; subscribes to all topics whose name ends so as they are advertised.
    fn solution(&mut self, ending: &str) -> Solution {
        loop {
            match self.next() {
                Frame::Data { subscription, bytes } => match Record::decode(&self.schemas[&subscription], &bytes) {
                    Ok(Some(Record::Solution(solution))) => return solution,
                    other => panic!("{other:?}"),
                },
                Frame::Text(told) if told["op"] == "advertise" => {
                    let channels = told["channels"].as_array().unwrap().iter();
                    for channel in channels.filter(|channel| channel["topic"].as_str().unwrap().ends_with(ending)) {
                        assert_eq!(channel["encoding"], "protobuf");
                        let id = channel["id"].as_u64().unwrap();
                        self.schemas.insert(id, channel["schemaName"].as_str().unwrap().to_owned());
                        self.say(&json!({"op": "subscribe", "subscriptions": [{"id": id, "channelId": id}]}));
                    }
                }
                Frame::Text(_) => {}
            }
        }
    }
}

#[test]
fn a_viewer_gets_the_recordings_messages_of_one_launch_after_the_other() {
    let _alone = one_at_a_time();
    let place = Place::new();
    let configuration = place.write("demo.toml", &demo(5, 1.0));
    let (mut server, address) = Server::start(&place);
    let mut viewer = Viewer::connect(&address);
    let launch = Launch::start(&place, "first", &configuration, Some("9s"));
    let mut seen = SolutionFile::new(Vec::new()).unwrap();
    for _ in 0..300 {
        seen.write(&viewer.solution("area/radar/solution")).unwrap();
    }
    let ended = launch.end();
    ended.well();
    let file = ended.solutions("radar");
    let seen = String::from_utf8(seen.finish().unwrap()).unwrap();
    assert!(file.contains(seen.split_once('\n').unwrap().1), "the solutions shown are not those written");

    let launch = Launch::start(&place, "second", &configuration, None);
    let other = loop {
        let solution = viewer.solution("area/radar/solution");
        if solution.header.time_ns < 3_000_000_000 {
            break solution.header.run_id;
        }
    };
    launch.signal(SIGKILL);
    drop(launch);
    let third = Launch::start(&place, "third", &configuration, None);
    while viewer.solution("area/radar/solution").header.run_id == other {}
    third.signal(SIGTERM);
    third.end();

    send(server.child.id(), SIGTERM);
    let mut told = String::new();
    server.child.stdout.take().unwrap().read_to_string(&mut told).unwrap();
    assert!(server.child.wait().unwrap().success());
    assert!(told.starts_with("1 viewers, ") && told.contains(" 0 lost on the way here, 0 times"), "{told}");
}
