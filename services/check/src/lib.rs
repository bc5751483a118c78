//! Checks a configuration and the head of each recording.
