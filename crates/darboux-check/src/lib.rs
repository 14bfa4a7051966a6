//! Finds what is wrong with the tangents, normals, UVs and normal maps of glTF models.
//!
//! ```text
//! measure/   facts of a surface, map or material, one file per measurement
//! rules/     facts -> defects: what is wrong, with all indices and numbers; no rule knows another
//! repair/    defects -> plan: edits; applied, and kept only where the defects shrank
//! words/     defects -> findings, as people read them
//! ```
//!
//! [`Code`] lists all findings, with what each looks like on screen, how it comes about and the cure.
//! [`fix_document`] and [`fix_map`] repair what can be repaired without guessing.
//!
//! ```
//! use std::path::Path;
//!
//! use darboux_check::{CheckOptions, check_document};
//! use darboux_io::LoadOptions;
//! use darboux_io::gltf::Document;
//!
//! let model = Path::new("../../assets/NormalTangentTest/NormalTangentTest.glb");
//! let document = Document::open(model, &LoadOptions::default())?;
//! for finding in check_document(&document, &CheckOptions::default())? {
//!     println!("{}: {}: {}", finding.place, finding.code, finding.text);
//! }
//! # Ok::<(), darboux_io::Error>(())
//! ```

mod cancelling;
mod check;
mod check_options;
mod code;
mod damage;
mod defect;
mod diagnosis;
mod facts;
mod finding;
mod hypotheses;
mod indices;
mod instances;
mod inverted;
mod judged;
mod map_users;
mod measure;
mod model_area;
mod obstacles;
mod once_per;
mod place;
mod repair;
mod report;
mod reported_findings;
mod rules;
mod severity;
mod surface;
mod tilts;
mod words;

pub use check::{
    CheckedMap, ModelOfMaps, check_document, check_map, check_map_on_model, check_model_of_maps,
};
pub use check_options::{AssumedMap, CheckOptions, MapConvention};
pub use code::Code;
pub use diagnosis::diagnosis;
pub use finding::{Evidence, Finding};
pub use judged::{ReportedJudgement, ReportedRecipe, ReportedTiles};
pub use measure::map::MapDirections;
pub use place::Place;
pub use repair::{
    Change, FixOptions, FixedDocument, FixedFinding, FixedMap, PlannedEdit, fix_document, fix_map,
    fix_map_on_model, plan_repair,
};
pub use report::{ReportedFinding, statements};
pub use reported_findings::ReportedFindings;
pub use severity::Severity;
