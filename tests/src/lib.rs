//! The test harness of the workspace: engines, comparators, generators and the cases of the conformance
//! suite.
//!
//! [`engine`] runs one mesh through one implementation, [`compare`] compares results, [`generate`] makes
//! meshes from a seed or from a fuzzer's bytes, [`corpus`] reads the cases of the conformance suite,
//! [`shrink`] shrinks a failing mesh to a new case.

pub mod check;
pub mod compare;
pub mod corpus;
mod damage;
pub mod engine;
pub mod families;
pub mod generate;
pub mod maps;
pub mod mesh;
mod model_part;
pub mod models;
pub mod oracle;
pub mod shrink;

pub use check::{all_modes, check_frames, split_and_plan};
pub use compare::{Difference, assert_equal, first_difference};
pub use darboux_dice::Dice;
pub use engine::{Engine, engines};
pub use generate::Case;
pub use mesh::{FaceSizes, OwnedMesh};

/// All methods, in the order of their codes.
pub const METHODS: &[darboux::Method] = <darboux::Method as darboux::Choice>::ALL;

/// The examples of docs/rust.md run.
#[cfg(doctest)]
#[doc = include_str!("../../docs/rust.md")]
struct RustPage;

/// The README's example runs.
#[cfg(doctest)]
#[doc = include_str!("../../README.md")]
struct Readme;

/// The Rust blocks of the lessons run.
#[cfg(doctest)]
mod lessons {
    #[doc = include_str!("../../docs/learn/2-two-derivatives.md")]
    struct TwoDerivatives;
    #[doc = include_str!("../../docs/learn/4-perpendicular.md")]
    struct Perpendicular;
    #[doc = include_str!("../../docs/learn/6-weights.md")]
    struct Weights;
    #[doc = include_str!("../../docs/learn/7-mikktspace.md")]
    struct Mikktspace;
}
