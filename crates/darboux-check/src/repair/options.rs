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
    /// The codes that are repaired; none: all, but tangents of known methods other than MikkTSpace stay.
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
    /// again, and those of another known method where their code is named.
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
        defect.obstacle.as_ref().filter(|obstacle| !self.overcomes(obstacle))
    }

    /// Whether the choice of codes overcomes the obstacle of a defect whose code is chosen.
    fn overcomes(&self, obstacle: &Obstacle) -> bool {
        *obstacle == Obstacle::BakedWithMethod && self.codes.is_some()
    }

    /// The findings of a check as a repair with these options sees them: tangents of a known method can be
    /// repaired where their code is named.
    #[must_use]
    pub fn seen(&self, findings: Vec<Finding>) -> Vec<Finding> {
        let seen = |defect: Defect| {
            let is_chosen = self.chooses(defect.reported_code());
            let obstacle =
                defect.obstacle.clone().filter(|obstacle| !(is_chosen && self.overcomes(obstacle)));
            Defect { obstacle, ..defect }
        };
        let of_finding = |finding: Finding| words::of_group(finding.defects.into_iter().map(seen).collect());
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
