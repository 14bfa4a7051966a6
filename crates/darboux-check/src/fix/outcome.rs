//! [`FixedFinding`]: a finding and what became of it.

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
    /// Whether it was cured.
    pub cured: bool,
}

/// Whether two findings say the same of the same place.
pub fn is_same(a: &Finding, b: &Finding) -> bool {
    (a.code, &a.place.primitive, a.place.material, a.place.image)
        == (b.code, &b.place.primitive, b.place.material, b.place.image)
}

/// What became of a finding. `remaining`: the findings after the repair.
pub fn outcome(finding: Finding, remaining: &[Finding], options: &FixOptions) -> FixedFinding {
    if !options.repairs(&finding) {
        let reason = Some("its code is not among those to repair".to_owned());
        return FixedFinding { finding: finding.with_obstacle(reason), cured: false };
    }
    let is_asked_for = finding.code == Code::TangentOtherRecipe && options.asks_for_other_recipe();
    match remaining.iter().find(|left| is_same(left, &finding)).filter(|_| !is_asked_for) {
        None => FixedFinding { finding, cured: true },
        Some(left) => {
            let reason =
                left.left_because.clone().unwrap_or_else(|| "the repair did not remove it".to_owned());
            FixedFinding { finding: finding.with_obstacle(Some(reason)), cured: false }
        }
    }
}
