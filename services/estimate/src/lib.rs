//! The estimator as a process.
