//! The JSON report of `darboux compare`. json.txt documents its fields.

use serde::Serialize;

use super::statistics::{ComparedPrimitive, Statistics, WorstCorner};

/// The report of a comparison.
#[derive(Serialize)]
pub struct CompareReport {
    pub command: &'static str,
    pub version: &'static str,
    pub first: String,
    pub second: Option<String>,
    /// The name of the method that takes the place of the second file.
    pub method: Option<String>,
    /// The statistics of all primitives together.
    pub totals: Statistics,
    pub primitives: Vec<ComparedPrimitive>,
    pub worst: Vec<WorstCorner>,
    pub verdict: Verdict,
    pub heat_map: Option<String>,
    pub within_tolerance: Option<bool>,
    pub warnings: Vec<String>,
}

/// The result of a comparison.
#[derive(Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Verdict {
    /// Every corner has the same tangent and sign, bit for bit.
    Identical,
    /// No corner differs by more than rounding.
    Close,
    /// A corner differs by more than rounding, or only one side has tangents.
    Different,
}

impl Verdict {
    /// `one_sided`: whether a primitive has tangents on one side only.
    pub fn new(totals: &Statistics, one_sided: bool) -> Self {
        if one_sided || totals.different > 0 {
            Self::Different
        } else if totals.identical == totals.corners {
            Self::Identical
        } else {
            Self::Close
        }
    }
}
