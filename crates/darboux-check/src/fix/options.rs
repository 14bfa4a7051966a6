//! [`FixOptions`]: what is repaired, and how.

use std::collections::BTreeSet;

use darboux::{Method, NormalOptions, TangentOptions};

use crate::check::CheckOptions;
use crate::code::Code;
use crate::finding::Finding;

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

    /// Whether the options ask for another recipe than MikkTSpace.
    pub(super) fn asks_for_other_recipe(&self) -> bool {
        !matches!(self.tangents.method, Method::MikkTSpace(_))
    }

    /// Whether a finding is to be repaired, and can be.
    pub(super) fn repairs(&self, finding: &Finding) -> bool {
        finding.is_fixable() && self.codes.as_ref().is_none_or(|codes| codes.contains(&finding.code))
    }
}
