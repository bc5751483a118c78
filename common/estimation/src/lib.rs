//! The mathematics of deck deformation, without clock, file, thread or transport.
