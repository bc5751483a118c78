//! Starts, watches, restarts and stops the process set.
