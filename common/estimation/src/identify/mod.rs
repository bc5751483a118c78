//! Identification of the flexure model.
