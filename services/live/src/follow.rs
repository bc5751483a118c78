use crate::inputs::Inputs;
use crate::server::Server;
use pipeline::configuration::{Configuration, ConfigurationError};
use runtime::{Launch, Lookout, Stop, TransportError, monotonic_ns, scheduling};
use std::fmt;
use std::net::SocketAddr;
use std::path::PathBuf;
use std::thread;
use std::time::Duration;

/// What the user asks for.
#[derive(Clone, Debug)]
pub struct Options {
    /// The configuration whose launch is shown; `None` for the one that runs.
    pub configuration: Option<PathBuf>,
    /// Where viewers connect; port 0 takes a free one.
    pub listen: SocketAddr,
}

/// Where it is said what a watch should know: one line at a time.
pub type Say = fn(&str);

/// Why there is nothing for viewers.
#[derive(Debug, thiserror::Error)]
pub enum LiveError {
    /// The operating system refuses.
    #[error(transparent)]
    Transport(#[from] TransportError),
    /// The configuration cannot be used.
    #[error(transparent)]
    Configuration(#[from] ConfigurationError),
    /// Nobody could connect.
    #[error("cannot listen on {address}: {reason}")]
    Listen {
        /// As it was asked for.
        address: SocketAddr,
        /// What the server says.
        reason: foxglove::FoxgloveError,
    },
}

/// What was done.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Report {
    /// Viewers that connected.
    pub viewers: u64,
    /// Messages that went to at least one of them.
    pub given: u64,
    /// Messages that never arrived here.
    pub lost: u64,
    /// Half minutes in which a viewer's queue was full, so that its oldest messages were dropped.
    pub full: u64,
}

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { viewers, given, lost, full } = self;
        write!(
            f,
            "{viewers} viewers, {given} messages shown, {lost} lost on the way here, {full} times a viewer's queue was full"
        )
    }
}

/// How long the ports are left alone.
const NAP: Duration = Duration::from_millis(20);
/// A launch is looked for, and its life checked, so often, ns.
const LOOK_NS: i64 = 1_000_000_000;

/// Serves until a signal comes.
///
/// # Errors
/// The address cannot be listened on, or the configuration cannot be read. A launch that ends or cannot be attached to is no error:
/// the next one is waited for.
pub fn run(options: &Options, say: Say) -> Result<Report, LiveError> {
    if let Some(path) = &options.configuration {
        Configuration::read(path)?;
    }
    let stop = Stop::install()?;
    // before there are threads, which take it over: viewers must not cost the stages anything
    scheduling::lower();
    let server = Server::open(options.listen, say)?;
    say(&format!("listening on ws://{}", server.address()));
    let lookout = Lookout::new(options.configuration.as_deref());
    let mut follow =
        Follow { server, say, lookout, attached: None, looked_ns: None, said: String::new(), lost: 0, given: 0 };
    while !stop.requested() {
        follow.update(monotonic_ns());
        thread::sleep(NAP);
    }
    follow.detach();
    let Follow { server, lost, given, .. } = follow;
    Ok(Report { viewers: server.viewers(), given, lost, full: server.full() })
}

struct Follow {
    server: Server,
    say: Say,
    lookout: Lookout,
    attached: Option<(Launch, Inputs)>,
    looked_ns: Option<i64>,
    said: String,
    lost: u64,
    given: u64,
}

impl Follow {
    /// Passes on what has come; attaches, and lets go of a launch that ends.
    fn update(&mut self, now_ns: i64) {
        if let Some((_, inputs)) = &mut self.attached
            && let Err(error) = inputs.pass_on(&self.server)
        {
            self.detach();
            self.tell(format!("lost the launch: {error}"));
        }
        if self.looked_ns.is_some_and(|looked_ns| now_ns - looked_ns < LOOK_NS) {
            return;
        }
        self.looked_ns = Some(now_ns);
        match &self.attached {
            Some((launch, _)) if launch.is_alive() => {}
            Some(_) => {
                self.detach();
                self.tell("the launch has ended; waiting for the next one".to_owned());
            }
            None => self.attach(),
        }
    }

    fn attach(&mut self) {
        let launch = match self.lookout.look() {
            Ok(Some(launch)) => launch,
            Ok(None) if self.said.is_empty() => return self.tell("no launch runs now; waiting for one".to_owned()),
            Ok(None) => return,
            Err(error) => return self.tell(format!("cannot look for launches: {error}")),
        };
        let opened = Configuration::read(&launch.configuration)
            .map_err(LiveError::from)
            .and_then(|configuration| Ok(Inputs::open(&launch, &configuration, &self.server)?));
        match opened {
            Ok(inputs) => {
                self.tell(format!("attached to the launch of {}", launch.configuration.display()));
                self.attached = Some((launch, inputs));
            }
            Err(error) => self.tell(format!("cannot attach to the launch: {error}")),
        }
    }

    /// Takes the launch's topics from the viewers.
    fn detach(&mut self) {
        if let Some((_, inputs)) = self.attached.take() {
            let (given, lost) = inputs.close();
            self.given += given;
            self.lost += lost;
        }
    }

    /// Says it, unless it was said last.
    fn tell(&mut self, line: String) {
        if self.said != line {
            (self.say)(&line);
            self.said = line;
        }
    }
}
