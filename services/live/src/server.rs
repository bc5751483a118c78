//! The WebSocket and its topics.

use crate::words::Words;
use crate::{LiveError, Say};
use foxglove::websocket::{ChannelView, Client, ServerListener};
use foxglove::{
    ChannelBuilder, ChannelId, Context, FoxgloveError, RawChannel, Schema, SinkId, WebSocketServer,
    WebSocketServerHandle,
};
use recording::Record;
use std::net::SocketAddr;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

/// Messages that may wait for a viewer: some seconds of everything at 100 Hz. Beyond that its oldest are dropped.
const BACKLOG: usize = 2048;

/// The server.
pub struct Server {
    _handle: WebSocketServerHandle,
    context: Arc<Context>,
    callers: Arc<Callers>,
    words: &'static Words,
    address: SocketAddr,
}

/// Those who subscribed, as the server's threads tell.
#[derive(Default)]
struct Callers {
    new: Mutex<Vec<(ChannelId, SinkId)>>,
    viewers: AtomicU64,
}

impl ServerListener for Callers {
    fn on_subscribe(&self, client: Client, channel: ChannelView) {
        if let Some(sink) = client.sink_id() {
            self.new.lock().unwrap_or_else(PoisonError::into_inner).push((channel.id(), sink));
        }
    }

    fn on_client_connect(&self) {
        self.viewers.fetch_add(1, Ordering::Relaxed);
    }
}

impl Server {
    /// Listens.
    pub fn open(listen: SocketAddr, say: Say) -> Result<Self, LiveError> {
        let words = Words::install(say);
        let (context, callers) = (Context::new(), Arc::new(Callers::default()));
        let host = match listen {
            SocketAddr::V4(address) => address.ip().to_string(),
            SocketAddr::V6(address) => format!("[{}]", address.ip()),
        };
        let server = WebSocketServer::new()
            .name("deckflex")
            .context(&context)
            .bind(host, listen.port())
            .message_backlog_size(BACKLOG)
            .listener(Arc::clone(&callers) as Arc<dyn ServerListener>);
        let handle = server.start_blocking().map_err(|reason| LiveError::Listen { address: listen, reason })?;
        let address = SocketAddr::new(listen.ip(), handle.port());
        Ok(Self { _handle: handle, context, callers, words, address })
    }

    /// Where viewers connect.
    pub fn address(&self) -> SocketAddr {
        self.address
    }

    /// How many have connected.
    pub fn viewers(&self) -> u64 {
        self.callers.viewers.load(Ordering::Relaxed)
    }

    /// How often it was said that a viewer's queue is full.
    pub fn full(&self) -> u64 {
        self.words.full()
    }

    /// Offers a topic with the schema of a record.
    pub fn channel(&self, topic: &str, of: &Record) -> Result<Arc<RawChannel>, FoxgloveError> {
        ChannelBuilder::new(topic)
            .context(&self.context)
            .message_encoding("protobuf")
            .schema(Schema::new(of.schema_name(), "protobuf", of.schema()))
            .build_raw()
    }

    /// Who has subscribed to what since the last time.
    pub fn subscribed(&self) -> Vec<(ChannelId, SinkId)> {
        std::mem::take(&mut self.callers.new.lock().unwrap_or_else(PoisonError::into_inner))
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use messages::Solution;
    use std::io::{Read, Write};
    use std::net::TcpStream;
    use std::time::{Duration, Instant};

    const UPGRADE: &str = "GET / HTTP/1.1\r\nHost: here\r\nUpgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Version: 13\r\n\
                           Sec-WebSocket-Key: AAAAAAAAAAAAAAAAAAAAAA==\r\nSec-WebSocket-Protocol: foxglove.sdk.v1\r\n\r\n";

    fn until(what: &str, seen: impl Fn() -> bool) {
        let start = Instant::now();
        while !seen() {
            assert!(start.elapsed() < Duration::from_secs(20), "{what}");
            std::thread::sleep(Duration::from_millis(2));
        }
    }

    /// It subscribes and then reads nothing.
    #[test]
    fn a_viewer_that_does_not_read_loses_messages_and_holds_up_nobody() {
        let server = Server::open("127.0.0.1:0".parse().unwrap(), |_| {}).unwrap();
        let record = Record::from(Solution::default());
        let channel = server.channel("area/radar/solution", &record).unwrap();
        let mut viewer = TcpStream::connect(server.address()).unwrap();
        viewer.write_all(UPGRADE.as_bytes()).unwrap();
        viewer.read_exact(&mut [0; 12]).unwrap();
        let subscribe =
            format!(r#"{{"op":"subscribe","subscriptions":[{{"id":1,"channelId":{}}}]}}"#, u64::from(channel.id()));
        // one frame of text, masked by zeros
        let mut frame = vec![0x81, 0x80 | subscribe.len() as u8, 0, 0, 0, 0];
        assert!(subscribe.len() < 126);
        frame.extend_from_slice(subscribe.as_bytes());
        viewer.write_all(&frame).unwrap();
        until("no subscription", || channel.has_sinks());
        assert_eq!((server.viewers(), server.full()), (1, 0));
        until("nobody waits for a subscription", || !server.subscribed().is_empty());

        // more than the operating system holds for both ends, and the backlog
        let bytes = record.encode();
        let start = Instant::now();
        (0..100_000).for_each(|_| channel.log(&bytes));
        assert!(start.elapsed() < Duration::from_secs(20), "{:?}", start.elapsed());
        assert_eq!(server.full(), 1);
    }
}
