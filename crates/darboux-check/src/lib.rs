//! Finds what is wrong with the tangents, normals, UVs and normal maps of glTF models.
//!
//! A *rule* looks at one surface, map or material and returns findings; no rule knows another. [`Code`] lists all findings, with what each
//! looks like on screen, how it comes about and the cure. [`fix_document`] and [`fix_map`] repair what can be repaired without guessing.
//!
//! ```
//! use std::path::Path;
//!
//! use darboux_check::{CheckOptions, check_document};
//! use darboux_io::LoadOptions;
//! use darboux_io::gltf::Document;
//!
//! let model = Path::new("../../assets/NormalTangentTest/NormalTangentTest.glb");
//! let mut document = Document::open(model, &LoadOptions::default())?;
//! for finding in check_document(&mut document, &CheckOptions::default())? {
//!     println!("{}: {}: {}", finding.place, finding.code, finding.text);
//! }
//! # Ok::<(), darboux_io::Error>(())
//! ```

mod cancelling;
mod check;
mod code;
mod contradiction;
mod expected;
mod facets;
mod finding;
mod fit;
mod fix;
mod instances;
mod map;
mod map_kind;
mod map_users;
mod obstacles;
mod orientation;
mod other_axes;
mod outliers;
mod overlap;
mod reordered;
mod reversed;
mod rule;
mod rules;
mod severity;
mod surface;
mod text;
mod turned;

pub use check::{
    CheckOptions, CheckedMap, ModelOfMaps, check_document, check_map, check_map_on_model, check_model_of_maps,
};
pub use code::Code;
pub use finding::{Evidence, Finding, Place};
pub use fix::{
    Change, FixOptions, FixedDocument, FixedFinding, FixedMap, fix_document, fix_map, fix_map_on_model,
};
pub use map::MapDirections;
pub use severity::Severity;
