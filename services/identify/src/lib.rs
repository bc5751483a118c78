//! Parameter identification as a process.
