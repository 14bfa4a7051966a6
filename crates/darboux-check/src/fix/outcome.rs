//! The results of repairs: each finding with whether it was repaired.

use serde::Serialize;

use super::options::FixOptions;
use crate::code::Code;
use crate::finding::Finding;

/// What a repair did to the tangents of a primitive.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[non_exhaustive]
#[serde(tag = "kind", rename_all = "snake_case")]
pub enum Change {
    /// Some were corrected, and the others kept.
    CorrectedTangents {
        /// The number of vertices.
        count: usize,
    },
    /// All were computed again.
    RecomputedTangents,
}

/// A finding and what became of it.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct FixedFinding {
    /// The finding before the repair; [`Finding::left_because`] says why it is still there.
    #[serde(flatten)]
    pub finding: Finding,
    /// Whether it is gone: repaired, or together with what was.
    pub repaired: bool,
    /// What was done to the tangents of its primitive; none for findings about anything else, and where only the signs w were negated.
    pub change: Option<Change>,
    #[serde(rename = "fixable")]
    pub(super) was_fixable: bool,
}

/// The result of [`fix_document`](crate::fix_document).
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct FixedDocument {
    /// The findings, and those that the first repairs revealed.
    pub findings: Vec<FixedFinding>,
    /// Whether a repair was kept. If none was, the document differs from its file at most by being decompressed.
    pub is_changed: bool,
}

/// Whether two findings say the same of the same place. Tangents that are not those of the method that made the others are one thing, and that method
/// is another.
pub fn is_same(a: &Finding, b: &Finding) -> bool {
    let is_of_part = |finding: &Finding| finding.code == Code::TangentOtherRecipe && finding.lists_items();
    is_of_part(a) == is_of_part(b)
        && (a.code, &a.place.primitive, a.place.material, a.place.image)
            == (b.code, &b.place.primitive, b.place.material, b.place.image)
}

impl FixedFinding {
    /// Whether the check said that a repair removes it. [`Finding::left_because`] says why one that is still there is.
    pub fn was_fixable(&self) -> bool {
        self.was_fixable
    }

    /// A finding that is no longer there.
    pub(super) fn gone(finding: Finding) -> Self {
        Self { was_fixable: finding.is_fixable(), repaired: true, change: None, finding }
    }

    /// A finding that is still there; `reason` is that of one that could have been repaired, as a clause.
    pub(super) fn left(finding: Finding, reason: impl Into<String>) -> Self {
        let was_fixable = finding.is_fixable();
        let finding = finding.with_obstacle(Some(reason.into()));
        Self { finding, repaired: false, change: None, was_fixable }
    }
}

/// What became of a finding. `remaining`: the findings after the repair.
pub fn outcome(finding: Finding, remaining: &[Finding], options: &FixOptions) -> FixedFinding {
    let Some(same) = remaining.iter().find(|left| is_same(left, &finding)) else {
        return FixedFinding::gone(finding);
    };
    let is_other_method = finding.code == Code::TangentOtherRecipe && options.asks_for_other_recipe();
    let reason = match same.left_because.as_deref() {
        _ if !options.repairs(&finding) => "its code is not among those to repair",
        _ if is_other_method => "another method than MikkTSpace was asked for",
        Some(reason) => reason,
        None => "the repair did not remove it",
    };
    FixedFinding::left(finding, reason)
}
