//! Recorded units as a process.
