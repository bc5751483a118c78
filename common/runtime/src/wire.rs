use iceoryx2::prelude::ZeroCopySend;
use messages::Message;

/// A message as it lies in shared memory: gives it the transport's identity without the crate `messages` knowing the transport.
#[repr(transparent)]
#[derive(Clone, Copy, Debug, Default)]
pub struct Wire<M: Message>(pub M);

// SAFETY: a Message is repr(C) without pointers, references or handles, and Wire is transparent.
unsafe impl<M: Message> ZeroCopySend for Wire<M> {
    unsafe fn type_name() -> &'static str {
        M::TYPE_NAME
    }
}
