//! [`FixOptions`]: what is repaired, and how.

use std::collections::BTreeSet;

use darboux::{Method, NormalOptions, TangentOptions};

use crate::check_options::CheckOptions;
use crate::code::Code;
use crate::defect::{Defect, Fault, TangentFault};
use crate::measure::recipe::Recognised;

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
    /// The codes that are repaired; none: all.
    pub codes: Option<BTreeSet<Code>>,
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

    /// Whether a defect is to be repaired, and can be. Tangents that the wanted method made are not made
    /// again.
    pub(super) fn repairs(&self, defect: &Defect) -> bool {
        let is_wanted_method = || match &defect.fault {
            Fault::Tangent(TangentFault::OtherRecipe { recognised, .. }) => self.is_other_method(recognised),
            _ => false,
        };
        self.chooses(defect.reported_code()) && defect.is_fixable() && !is_wanted_method()
    }

    /// Whether a code is among those to repair.
    pub(super) fn chooses(&self, code: Code) -> bool {
        self.codes.as_ref().is_none_or(|codes| codes.contains(&code))
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
