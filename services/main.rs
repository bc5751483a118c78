//! deckflex: deck deformation of a ship from two or more inertial units.

fn main() {}
