//! Time synchronisation as a process.
