//! The ship, its bending hull and its inertial units: what a filter may never see.
