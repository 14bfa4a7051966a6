//! [`Finding`]: one thing that is wrong, where, and the evidence.

use std::borrow::Cow;

use serde::Serialize;

use crate::check_options::AssumedMap;
use crate::code::Code;
use crate::defect::{Defect, Obstacle};
use crate::indices::Items;
use crate::place::Place;
use crate::severity::Severity;

/// A number that supports a finding.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Evidence {
    /// What was measured.
    pub what: &'static str,
    /// The value.
    pub value: f64,
    /// The unit: `degrees`, `corners`, `texels`, `%` and so on; empty for ratios.
    pub unit: &'static str,
}

/// One thing that is wrong.
///
/// [`ReportedFinding`](crate::ReportedFinding) has the same in one row, for JSON.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Finding {
    /// The kind.
    pub code: Code,
    /// How bad it is here.
    pub severity: Severity,
    /// Where it is.
    pub place: Place,
    /// The number of vertices, corners, faces or texels that show it, as the text says; 1 for a property of
    /// the whole.
    pub count: usize,
    /// The indices of the first ones, in the order of the file; empty for a property of the whole.
    pub first: Vec<usize>,
    /// The numbers that support it.
    pub evidence: Vec<Evidence>,
    /// What is wrong here, in one sentence.
    pub text: String,
    /// The cure here: what the reader can do.
    pub cure: Cow<'static, str>,
    /// Why a repair leaves it, as a clause; none where [`fix_document`](crate::fix_document) or
    /// [`fix_map`](crate::fix_map) repairs it.
    pub left_because: Option<String>,
    /// What it says: one defect, or several that are one finding.
    pub(crate) defects: Vec<Defect>,
}

impl Finding {
    /// What the user may say of the map, with `--assume`, so that a repair does not leave it.
    pub(crate) fn suggested_assumption(&self) -> Option<AssumedMap> {
        let obstacle = self.defects.iter().find_map(|defect| defect.obstacle.as_ref());
        obstacle.and_then(Obstacle::suggested_assumption)
    }

    /// Whether it can be repaired.
    pub fn is_fixable(&self) -> bool {
        self.defects.iter().all(Defect::is_fixable)
    }

    /// What [`Finding::first`] numbers, where it has elements: `triangles` or `vertices`.
    pub(crate) fn first_are(&self) -> &'static str {
        match self.defects.first().and_then(|defect| defect.fault.items()) {
            Some(Items::Triangles(_)) => "triangles",
            Some(Items::Vertices(_)) | None => "vertices",
        }
    }
}
