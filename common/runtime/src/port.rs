use crate::service::{Refusal, Services, open, persist, port_refusal};
use crate::waiter::Wake;
use crate::{Node, TransportError, Wire};
use iceoryx2::port::listener::{Listener, ListenerCreateError, ListenerWaitError};
use iceoryx2::port::notifier::{Notifier, NotifierCreateError};
use iceoryx2::port::publisher::PublisherCreateError;
use iceoryx2::port::subscriber::SubscriberCreateError;
use iceoryx2::port::update_connections::UpdateConnections;
use iceoryx2::prelude::{BackpressureStrategy, FileDescriptorBased, ipc};
use messages::Message;
use messages::topic::Topic;
use std::fmt::Debug;
use std::os::fd::RawFd;

/// The writing end of a topic, of which there is one at a time.
///
/// It never waits for a reader: one that falls behind by more than the topic's depth loses its oldest messages.
///
/// A reader connects when it takes, and the opening of a publisher wakes it to do so. What was sent stays readable when the publisher
/// is gone, but only for readers that connected before: whoever sends little and leaves should stay for a second.
#[derive(Debug)]
pub struct Publisher<M: Message> {
    topic: String,
    data: iceoryx2::port::publisher::Publisher<ipc::Service, Wire<M>, ()>,
    notifier: Notifier<ipc::Service>,
}

impl<M: Message> Publisher<M> {
    /// Opens the writing end, waiting up to two seconds for the place of a dying predecessor.
    ///
    /// # Errors
    /// If the topic has a living publisher or another type, or if the transport is poisoned.
    pub fn open(node: &Node, topic: &Topic<M>) -> Result<Self, TransportError> {
        persist(|| Self::attempt(open(node, topic)?, &topic.name))
    }

    fn attempt(services: Services<M>, topic: &str) -> Result<Self, Refusal> {
        let data = services
            .data
            .publisher_builder()
            .max_loaned_samples(1)
            .backpressure_strategy(BackpressureStrategy::DiscardData)
            .create()
            .map_err(|e| {
                port_refusal(topic, e == PublisherCreateError::ExceedsMaxSupportedPublishers, format!("{e:?}"))
            })?;
        let notifier = services.event.notifier_builder().create().map_err(|e| {
            port_refusal(topic, e == NotifierCreateError::ExceedsMaxSupportedNotifiers, format!("{e:?}"))
        })?;
        Ok(Self { topic: topic.to_owned(), data, notifier })
    }

    /// Sends one message, wakes the readers and gives their number.
    ///
    /// # Errors
    /// If the transport refuses, which it does not for want of room or of readers.
    pub fn publish(&self, message: &M) -> Result<usize, TransportError> {
        let sample = self.data.loan_uninit().map_err(|e| failure("publish on", &self.topic, e))?;
        let readers = sample.write_payload(Wire(*message)).send().map_err(|e| failure("publish on", &self.topic, e))?;
        self.notifier.notify().map_err(|e| failure("notify the readers of", &self.topic, e))?;
        Ok(readers)
    }

    /// Hands the last message of a latched topic to readers that came after it, which otherwise get it with the next one.
    /// Does not wake them. Costs next to nothing when nobody came.
    ///
    /// # Errors
    /// If the transport refuses.
    pub fn refresh(&self) -> Result<(), TransportError> {
        self.data.update_connections().map_err(|e| failure("refresh", &self.topic, e))
    }
}

/// A reading end of a topic.
#[derive(Debug)]
pub struct Subscriber<M: Message> {
    topic: String,
    data: iceoryx2::port::subscriber::Subscriber<ipc::Service, Wire<M>, ()>,
    listener: Listener<ipc::Service>,
}

impl<M: Message> Subscriber<M> {
    /// Opens a reading end, waiting up to two seconds for the place of a dying predecessor.
    ///
    /// # Errors
    /// If all places are taken or the topic has another type, or if the transport is poisoned.
    pub fn open(node: &Node, topic: &Topic<M>) -> Result<Self, TransportError> {
        persist(|| Self::attempt(open(node, topic)?, topic))
    }

    fn attempt(services: Services<M>, topic: &Topic<M>) -> Result<Self, Refusal> {
        let name = &topic.name;
        // Before the subscriber, so that no message can arrive without its event.
        let listener = services.event.listener_builder().create().map_err(|e| {
            port_refusal(name, e == ListenerCreateError::ExceedsMaxSupportedListeners, format!("{e:?}"))
        })?;
        let data = services
            .data
            .subscriber_builder()
            .buffer_size(topic.depth)
            .history_request(topic.history)
            .create()
            .map_err(|e| {
                port_refusal(name, e == SubscriberCreateError::ExceedsMaxSupportedSubscribers, format!("{e:?}"))
            })?;
        Ok(Self { topic: name.clone(), data, listener })
    }

    /// Takes the oldest message that has not been taken, `None` when there is no more.
    ///
    /// # Errors
    /// If the connection to the publisher cannot be made.
    pub fn take(&self) -> Result<Option<M>, TransportError> {
        let sample = self.data.receive().map_err(|e| failure("take from", &self.topic, e))?;
        Ok(sample.map(|sample| sample.payload().0))
    }
}

impl<M: Message> Wake for Subscriber<M> {
    fn descriptor(&self) -> RawFd {
        // SAFETY: the number is only polled, while `self`, which owns the socket, is borrowed.
        unsafe { self.listener.file_descriptor().native_handle() }
    }

    fn drain(&self) -> Result<(), TransportError> {
        match self.listener.try_wait(|_| {}) {
            Ok(_) | Err(ListenerWaitError::InterruptSignal) => Ok(()),
            Err(error) => Err(failure("read the events of", &self.topic, error)),
        }
    }
}

/// Keeps a topic in existence without reading or writing it.
///
/// A process that is killed while it CREATES a topic poisons the domain; one that is killed while it opens an existing topic does
/// not. A launcher that anchors all topics before it starts the stages therefore survives their deaths at any time.
pub struct Anchor<M: Message> {
    _services: Services<M>,
}

impl<M: Message> Anchor<M> {
    /// Creates the topic, or opens it.
    ///
    /// # Errors
    /// If the topic has another type, or if the transport is poisoned.
    pub fn open(node: &Node, topic: &Topic<M>) -> Result<Self, TransportError> {
        persist(|| open(node, topic)).map(|_services| Self { _services })
    }
}

fn failure(action: &'static str, topic: &str, reason: impl Debug) -> TransportError {
    TransportError::Port { action, topic: topic.to_owned(), reason: format!("{reason:?}") }
}
