use crate::TransportError;
use std::io;
use std::os::fd::RawFd;
use std::time::Duration;

/// Something with news now and then.
pub trait Wake {
    /// A file descriptor that becomes readable with news.
    fn descriptor(&self) -> RawFd;
    /// Consumes the news of the descriptor, so that it sleeps again.
    ///
    /// # Errors
    /// If the descriptor cannot be read.
    fn drain(&self) -> Result<(), TransportError>;
}

/// Sleeps until one of several topics has news.
///
/// It polls the listeners' own descriptors rather than attach them to the transport's wait set, which would have to borrow every
/// subscriber for as long as it lives, allocates on each call and rounds time-outs up to the next millisecond.
#[derive(Debug, Default)]
pub struct Waiter {
    polled: Vec<libc::pollfd>,
}

impl Waiter {
    /// A waiter without memory of any topic.
    pub fn new() -> Self {
        Self::default()
    }

    /// Returns when a topic has news, when the time-out has passed, or when a signal came; which of them it was does not matter to
    /// a stage that then takes from every topic until there is no more. What was left untaken does not wake again.
    /// It may return early without any of them. A signal that comes just before the call is only seen after the time-out.
    ///
    /// # Errors
    /// If a topic's descriptor cannot be polled or drained.
    pub fn wait(&mut self, topics: &[&dyn Wake], timeout: Duration) -> Result<(), TransportError> {
        self.polled.clear();
        self.polled.extend(topics.iter().map(|topic| libc::pollfd {
            fd: topic.descriptor(),
            events: libc::POLLIN,
            revents: 0,
        }));
        if !poll(&mut self.polled, timeout)? {
            return Ok(());
        }
        for (polled, topic) in self.polled.iter().zip(topics) {
            if polled.revents & libc::POLLIN != 0 {
                topic.drain()?;
            } else if polled.revents != 0 {
                return Err(TransportError::System {
                    call: "poll of a topic",
                    source: io::ErrorKind::BrokenPipe.into(),
                });
            }
        }
        Ok(())
    }
}

/// Whether a descriptor is ready; not so after the time-out or a signal.
fn poll(polled: &mut [libc::pollfd], timeout: Duration) -> Result<bool, TransportError> {
    let timeout = libc::timespec {
        tv_sec: libc::time_t::try_from(timeout.as_secs()).unwrap_or(libc::time_t::MAX),
        tv_nsec: timeout.subsec_nanos().into(),
    };
    let count = polled.len() as libc::nfds_t;
    // SAFETY: the array holds `count` entries, the time-out lives through the call, and no signal mask is given.
    match unsafe { libc::ppoll(polled.as_mut_ptr(), count, &timeout, std::ptr::null()) } {
        -1 if io::Error::last_os_error().kind() == io::ErrorKind::Interrupted => Ok(false),
        -1 => Err(TransportError::last_os("poll")),
        ready => Ok(ready > 0),
    }
}
