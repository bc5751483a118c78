//! Configuration, data sources and the offline loop.
