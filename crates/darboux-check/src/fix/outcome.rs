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
    /// Whether it was repaired.
    pub repaired: bool,
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

/// What became of a finding. `remaining`: the findings after the repair.
pub fn outcome(finding: Finding, remaining: &[Finding], options: &FixOptions) -> FixedFinding {
    let left = |finding: Finding, reason: String| FixedFinding {
        finding: finding.with_obstacle(Some(reason)),
        repaired: false,
    };
    if !options.repairs(&finding) {
        return left(finding, "its code is not among those to repair".to_owned());
    }
    match remaining.iter().find(|left| is_same(left, &finding)) {
        None => FixedFinding { finding, repaired: true },
        Some(_) if finding.code == Code::TangentOtherRecipe && options.asks_for_other_recipe() => {
            left(finding, "another method than MikkTSpace was asked for".to_owned())
        }
        Some(same) => {
            let reason = same.left_because.clone();
            left(finding, reason.unwrap_or_else(|| "the repair did not remove it".to_owned()))
        }
    }
}
