//! Frames, signs, axes and units: the one page of conventions.
//!
//! | what | convention |
//! |---|---|
//! | body axes | x to starboard, y to the bow, z up, right-handed |
//! | navigation frame | x east, y north, z up |
//! | heading | clockwise from north, 0 to 2 pi |
//! | roll | positive with the port side up: about the body's y axis |
//! | pitch | positive with the bow up: about the body's x axis |
//! | order | `C_b^n = Rz(-heading) Rx(pitch) Ry(roll)` |
//! | units of measure | SI: rad, rad/s, m, m/s, s; other units exist at the configuration's and the files' edge only |
//! | m, s | the main inertial unit, the sub unit on the deck area |
//! | `Rot<A, B>` | "A from B", `C_B^A`: turns a vector seen in B into the same vector seen in A |
//! | deformation | `Rot<Main, Sub>`, `C_s^m`; its rotation vector is seen in m |
//! | error of an estimate | `Log(C_hat C_true^T)`, seen in m |
//! | quaternion | `[w, x, y, z]`, `w >= 0`, Hamilton product, same sense as `Rot` |
//! | lever arm | from the main to the sub unit, in the main unit's axes |
//!
//! A rotation that is joined with a wrong frame does not compile:
//!
//! ```
//! use frames::{Main, Nav, Rot, Sub, Vec3};
//! let deformation = Rot::<Main, Sub>::exp(Vec3::new(0.01, 0.0, 0.0));
//! let attitude = Rot::<Nav, Main>::identity();
//! let deck: Rot<Nav, Sub> = attitude * deformation;
//! let bow_seen_in_nav: Vec3<Nav> = deck * Vec3::<Sub>::new(0.0, 1.0, 0.0);
//! # assert!(bow_seen_in_nav.z() > 0.0);
//! ```
//!
//! ```compile_fail
//! use frames::{Main, Nav, Rot, Sub, Vec3};
//! let deformation = Rot::<Main, Sub>::exp(Vec3::new(0.01, 0.0, 0.0));
//! let attitude = Rot::<Nav, Main>::identity();
//! let wrong = deformation * attitude;
//! ```

mod convert;
mod euler;
mod rotation;
pub mod unit;
mod vector;

pub use euler::Euler;
pub use rotation::Rot;
pub use vector::Vec3;

/// A coordinate frame; the implementors are markers without data.
pub trait Frame: Copy + std::fmt::Debug + PartialEq {}

macro_rules! frame {
    ($($(#[$doc:meta])* $name:ident),*) => {$(
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq)]
        pub struct $name;
        impl Frame for $name {}
    )*};
}

frame!(
    /// Body axes of the main inertial unit, m.
    Main,
    /// Body axes of a sub unit, s.
    Sub,
    /// East, north, up at the ship.
    Nav,
    /// The main unit's axes as they stood at the start of an accumulation, held in inertial space.
    MainStart,
    /// The sub unit's axes as they stood at the start of an accumulation, held in inertial space.
    SubStart,
    /// An inertial frame that coincided with `Nav` at the start of the run.
    Inertial,
    /// The axes that are printed on a unit, before its mounting turns them into body axes.
    Case
);
