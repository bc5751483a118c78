//! The shell: transport, clocks, scheduling and latency.
