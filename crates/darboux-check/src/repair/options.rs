//! [`FixOptions`]: what is repaired, and how.

use std::collections::BTreeSet;

use darboux::{Method, NormalOptions, TangentOptions};

use crate::check_options::CheckOptions;
use crate::code::Code;
use crate::defect::{Defect, Fault, Obstacle, TangentFault};
use crate::finding::Finding;
use crate::measure::recipe::Recognised;
use crate::words;

/// What is repaired, and how.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct FixOptions {
    /// What is checked.
    pub check: CheckOptions,
    /// How tangents are made again. Default: MikkTSpace.
    pub tangents: TangentOptions,
    /// How missing normals are made. Default: smooth.
    pub normals: NormalOptions,
    /// The codes that are repaired; none: all, but tangents with which the map may have been baked
    /// stay, unless `tangents` names another method than MikkTSpace.
    pub codes: Option<BTreeSet<Code>>,
    /// The codes that are left, of those.
    pub left: BTreeSet<Code>,
}

impl FixOptions {
    /// These options with other options of the check.
    #[must_use]
    pub fn with_check(self, check: CheckOptions) -> Self {
        Self { check, ..self }
    }

    /// These options with another way of making tangents.
    #[must_use]
    pub fn with_tangents(self, tangents: TangentOptions) -> Self {
        Self { tangents, ..self }
    }

    /// These options with another way of making normals.
    #[must_use]
    pub fn with_normals(self, normals: NormalOptions) -> Self {
        Self { normals, ..self }
    }

    /// These options for some codes only.
    #[must_use]
    pub fn with_codes(self, codes: impl IntoIterator<Item = Code>) -> Self {
        Self { codes: Some(codes.into_iter().collect()), ..self }
    }

    /// These options without some codes, which are left.
    #[must_use]
    pub fn without_codes(self, codes: impl IntoIterator<Item = Code>) -> Self {
        Self { left: codes.into_iter().collect(), ..self }
    }

    /// Whether a defect is to be repaired, and can be.
    pub(super) fn repairs(&self, defect: &Defect) -> bool {
        self.left_because(defect).is_none()
    }

    /// Why a defect is left; none where it is repaired. Tangents that the wanted method made are not made
    /// again, and those with which the map may have been baked only where their code or another method is
    /// named.
    pub(super) fn left_because<'a>(&self, defect: &'a Defect) -> Option<&'a Obstacle> {
        let is_wanted_method = || match &defect.fault {
            Fault::Tangent(TangentFault::OtherRecipe { recognised, .. }) => self.is_other_method(recognised),
            _ => false,
        };
        if !self.chooses(defect.reported_code()) {
            return Some(&Obstacle::NotChosen);
        }
        if is_wanted_method() {
            return Some(&Obstacle::OtherMethodWanted);
        }
        let chooses_tangents = self.codes.is_some() || self.asks_for_other_method();
        let is_overcome = |obstacle: &Obstacle| obstacle.yields_to_choice() && chooses_tangents;
        defect.obstacle.as_ref().filter(|obstacle| !is_overcome(obstacle))
    }

    /// The findings of a check, each with the reason for which a repair with these options leaves it.
    #[must_use]
    pub fn with_reasons(&self, findings: Vec<Finding>) -> Vec<Finding> {
        let with_reason = |defect: Defect| match self.left_because(&defect).cloned() {
            Some(reason) => defect.with_obstacle(Some(reason)),
            None => Defect { obstacle: None, ..defect },
        };
        let of_finding =
            |finding: Finding| words::of_group(finding.defects.into_iter().map(with_reason).collect());
        findings.into_iter().map(of_finding).collect()
    }

    /// Whether a code is among those to repair.
    pub(super) fn chooses(&self, code: Code) -> bool {
        self.codes.as_ref().is_none_or(|codes| codes.contains(&code)) && !self.left.contains(&code)
    }

    /// Whether the tangents were made by the wanted method, which is not MikkTSpace.
    fn is_other_method(&self, recognised: &Recognised) -> bool {
        self.asks_for_other_method() && recognised.best.recipe.method == self.tangents.method
    }

    /// Whether the options ask for another method than MikkTSpace.
    pub(super) fn asks_for_other_method(&self) -> bool {
        !matches!(self.tangents.method, Method::MikkTSpace(_))
    }
}
