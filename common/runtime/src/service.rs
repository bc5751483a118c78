//! How a topic becomes a service of the transport. The first process that opens a topic fixes its quality of service, so
//! there is this one place where it is set.

use crate::{Node, TransportError, Wire};
use iceoryx2::prelude::{EventId, ServiceName, ipc};
use iceoryx2::service::builder::event::{EventCreateError, EventOpenError, EventOpenOrCreateError};
use iceoryx2::service::builder::publish_subscribe::{
    PublishSubscribeCreateError as DataCreateError, PublishSubscribeOpenError as DataOpenError,
    PublishSubscribeOpenOrCreateError as DataOpenOrCreateError,
};
use iceoryx2::service::port_factory::{event, publish_subscribe};
use messages::Message;
use messages::topic::Topic;
use std::time::{Duration, Instant};

/// Readers of a topic at a time: the stages and at least two tools.
const MAX_READERS: usize = 6;
/// Places of dead publishers may still be taken when the next one starts to notify.
const MAX_NOTIFIERS: usize = 4;
/// Likewise for listeners, which are cleaned up apart from their subscribers.
const MAX_LISTENERS: usize = 2 * MAX_READERS;
/// Processes that may have the topic open, dead ones that nobody has cleaned up yet included.
const MAX_NODES: usize = 32;
/// How long an opening is tried again.
const PATIENCE: Duration = Duration::from_secs(2);
const PAUSE: Duration = Duration::from_millis(10);

/// The two services of a topic: the data, and the events that wake its readers.
pub(crate) struct Services<M: Message> {
    pub data: publish_subscribe::PortFactory<ipc::Service, Wire<M>, ()>,
    pub event: event::PortFactory<ipc::Service>,
}

/// A refused opening.
pub(crate) enum Refusal {
    /// Trying again is of no use.
    Final(TransportError),
    /// A predecessor is dying or somebody else is creating: worth another try.
    Passing(TransportError),
}

/// Opens the services of a topic, or creates them. All topics are made here and nowhere else.
pub(crate) fn open<M: Message>(node: &Node, topic: &Topic<M>) -> Result<Services<M>, Refusal> {
    let name = ServiceName::new(&topic.name).map_err(|_| Refusal::Final(TransportError::Name(topic.name.clone())))?;
    let data = node
        .inner
        .service_builder(&name)
        .publish_subscribe::<Wire<M>>()
        .max_publishers(1)
        .max_subscribers(MAX_READERS)
        .max_nodes(MAX_NODES)
        .subscriber_max_buffer_size(topic.depth)
        .history_size(topic.history)
        .subscriber_max_borrowed_samples(1)
        .enable_safe_overflow(true)
        .open_or_create()
        .map_err(|error| data_refusal(&topic.name, error))?;
    let event = node
        .inner
        .service_builder(&name)
        .event()
        .max_notifiers(MAX_NOTIFIERS)
        .max_listeners(MAX_LISTENERS)
        .max_nodes(MAX_NODES)
        .event_id_max_value(0)
        // A reader connects when it takes. One that has not done so since the writer came gets nothing of what a short-lived
        // writer sent, so the coming of a writer wakes it too.
        .notifier_created_event(EventId::new(0))
        .open_or_create()
        .map_err(|error| event_refusal(&topic.name, error))?;
    Ok(Services { data, event })
}

/// Repeats an opening while the reason for its refusal may pass, for about two seconds.
pub(crate) fn persist<T>(mut open: impl FnMut() -> Result<T, Refusal>) -> Result<T, TransportError> {
    let deadline = Instant::now() + PATIENCE;
    loop {
        match open() {
            Ok(value) => return Ok(value),
            Err(Refusal::Final(error)) => return Err(error),
            Err(Refusal::Passing(error)) if Instant::now() >= deadline => return Err(error),
            Err(Refusal::Passing(_)) => std::thread::sleep(PAUSE),
        }
    }
}

enum Kind {
    Incompatible,
    Forbidden,
    Full,
    Unable,
    Broken,
}

fn classify(topic: &str, kind: Kind, reason: String) -> Refusal {
    let topic = topic.to_owned();
    match kind {
        Kind::Incompatible => Refusal::Final(TransportError::Incompatible { topic, reason }),
        Kind::Forbidden => Refusal::Final(TransportError::Port { action: "open", topic, reason }),
        Kind::Full => Refusal::Passing(TransportError::Occupied { topic, reason }),
        Kind::Unable => Refusal::Passing(TransportError::Port { action: "open a port of", topic, reason }),
        Kind::Broken => Refusal::Passing(TransportError::Poisoned { name: topic, reason }),
    }
}

fn data_refusal(topic: &str, error: DataOpenOrCreateError) -> Refusal {
    use DataOpenOrCreateError::{
        PublishSubscribeCreateError as Create, PublishSubscribeOpenError as Open, SystemInFlux,
    };
    let kind = match error {
        Open(
            DataOpenError::IncompatibleTypes
            | DataOpenError::IncompatibleMessagingPattern
            | DataOpenError::IncompatibleAttributes
            | DataOpenError::IncompatibleOverflowBehavior
            | DataOpenError::DoesNotSupportRequestedMinBufferSize
            | DataOpenError::DoesNotSupportRequestedMinHistorySize
            | DataOpenError::DoesNotSupportRequestedMinSubscriberBorrowedSamples
            | DataOpenError::DoesNotSupportRequestedAmountOfPublishers
            | DataOpenError::DoesNotSupportRequestedAmountOfSubscribers
            | DataOpenError::DoesNotSupportRequestedAmountOfNodes
            | DataOpenError::VersionMismatch
            | DataOpenError::UnableToAcquireTypeDefinition
            | DataOpenError::InvalidTypeDefinition,
        )
        | Create(
            DataCreateError::SubscriberBufferMustBeLargerThanHistorySize
            | DataCreateError::UnableToAcquireTypeDefinition
            | DataCreateError::InvalidTypeDefinition,
        ) => Kind::Incompatible,
        Open(DataOpenError::InsufficientPermissions) | Create(DataCreateError::InsufficientPermissions) => {
            Kind::Forbidden
        }
        Open(DataOpenError::ExceedsMaxNumberOfNodes) => Kind::Full,
        Open(_) | Create(_) | SystemInFlux => Kind::Broken,
    };
    classify(topic, kind, format!("{error:?}"))
}

fn event_refusal(topic: &str, error: EventOpenOrCreateError) -> Refusal {
    use EventOpenOrCreateError::{EventCreateError as Create, EventOpenError as Open, SystemInFlux};
    let kind = match error {
        Open(
            EventOpenError::IncompatibleMessagingPattern
            | EventOpenError::IncompatibleAttributes
            | EventOpenError::IncompatibleDeadline
            | EventOpenError::IncompatibleNotifierCreatedEvent
            | EventOpenError::DoesNotSupportRequestedAmountOfNotifiers
            | EventOpenError::DoesNotSupportRequestedAmountOfListeners
            | EventOpenError::DoesNotSupportRequestedMaxEventId
            | EventOpenError::DoesNotSupportRequestedAmountOfNodes
            | EventOpenError::VersionMismatch,
        ) => Kind::Incompatible,
        Open(EventOpenError::InsufficientPermissions) | Create(EventCreateError::InsufficientPermissions) => {
            Kind::Forbidden
        }
        Open(EventOpenError::ExceedsMaxNumberOfNodes) => Kind::Full,
        Open(_) | Create(_) | SystemInFlux => Kind::Broken,
    };
    classify(topic, kind, format!("{error:?}"))
}

/// A port that was refused: for want of a place, or because the operating system did not give what it takes.
pub(crate) fn port_refusal(topic: &str, full: bool, reason: String) -> Refusal {
    classify(topic, if full { Kind::Full } else { Kind::Unable }, reason)
}
