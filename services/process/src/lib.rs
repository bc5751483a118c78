//! The offline loop over a configuration.
