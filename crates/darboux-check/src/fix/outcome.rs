//! The results of repairs: each finding with whether it was repaired.

use serde::Serialize;

use super::options::FixOptions;
use crate::code::Code;
use crate::finding::Finding;

/// A finding and what became of it.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct FixedFinding {
    /// The finding before the repair; [`Finding::left_because`] says why it is still there.
    #[serde(flatten)]
    pub finding: Finding,
    /// Whether it is gone: repaired, or together with what was.
    pub repaired: bool,
    /// Whether the check said that a repair removes it. [`Finding::left_because`] says why one that is still there is.
    pub fixable: bool,
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

/// Whether two findings say the same of the same place.
pub fn is_same(a: &Finding, b: &Finding) -> bool {
    (a.code, &a.place.primitive, a.place.material, a.place.image)
        == (b.code, &b.place.primitive, b.place.material, b.place.image)
}

impl FixedFinding {
    /// A finding that is no longer there.
    pub(super) fn gone(finding: Finding) -> Self {
        Self { fixable: finding.is_fixable(), repaired: true, finding }
    }

    /// A finding that is still there; `reason` is that of one that could have been repaired, as a clause.
    pub(super) fn left(finding: Finding, reason: impl Into<String>) -> Self {
        let fixable = finding.is_fixable();
        Self { finding: finding.with_obstacle(Some(reason.into())), repaired: false, fixable }
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
