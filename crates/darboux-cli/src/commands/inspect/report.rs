//! The JSON report of `darboux inspect`. json.txt documents its fields.

use darboux_io::gltf::PrimitiveInfo;
use serde::Serialize;

use super::recipe::MadeBy;

/// The report of a run.
#[derive(Serialize)]
pub struct InspectReport {
    pub command: &'static str,
    pub version: &'static str,
    pub files: Vec<InspectedFile>,
}

/// The primitives of one file, or the error that prevented reading it.
#[derive(Clone, Serialize)]
pub struct InspectedFile {
    pub input: String,
    pub error: Option<String>,
    pub warnings: Vec<String>,
    pub primitives: Vec<InspectedPrimitive>,
}

/// A primitive, and how its tangents were made.
#[derive(Clone, Serialize)]
pub struct InspectedPrimitive {
    #[serde(flatten)]
    pub info: PrimitiveInfo,
    pub made_by: Option<MadeBy>,
}
