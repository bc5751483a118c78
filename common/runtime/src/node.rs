use crate::{Domain, TransportError};
use iceoryx2::node::NodeCreationFailure;
use iceoryx2::prelude::{LogLevel, NodeBuilder, NodeName, SignalHandlingMode, ipc, set_log_level};

/// A process's foot in a domain. Ports are opened on it; it is not moved between threads.
#[derive(Debug)]
pub struct Node {
    pub(crate) inner: iceoryx2::prelude::Node<ipc::Service>,
}

impl Node {
    /// Opens a node; what dead processes left in the domain is cleaned up on the way.
    ///
    /// # Errors
    /// If the name is refused or the domain's files cannot be used.
    pub fn open(domain: &Domain, name: &str) -> Result<Self, TransportError> {
        set_log_level(LogLevel::Error);
        let node_name = NodeName::new(name).map_err(|_| TransportError::Name(name.to_owned()))?;
        let inner = NodeBuilder::new()
            .name(&node_name)
            .config(&domain.config()?)
            .signal_handling_mode(SignalHandlingMode::Disabled)
            .create::<ipc::Service>()
            .map_err(|failure| refusal(name, failure))?;
        Ok(Self { inner })
    }
}

fn refusal(name: &str, failure: NodeCreationFailure) -> TransportError {
    let (name, reason) = (name.to_owned(), format!("{failure:?}"));
    match failure {
        NodeCreationFailure::InternalError | NodeCreationFailure::SystemCorrupted => {
            TransportError::Poisoned { name, reason }
        }
        NodeCreationFailure::InsufficientPermissions | NodeCreationFailure::UnableToGenerateUniqueNodeId => {
            TransportError::Node { node: name, reason }
        }
    }
}
