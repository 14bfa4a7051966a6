//! [`Severity`]: how bad a finding is.

use std::fmt;

use serde::{Deserialize, Serialize};

/// The degrees from which on turned tangents and normals are seen.
pub const SEEN: f64 = 15.0;

/// In percent of the area of a model, or of the texels of a map: what defects of one kind damage together at
/// least to be errors. Half a percent of a model that fills a screen of 1920 x 1080 is a square of a hundred
/// pixels.
pub const MIN_DAMAGED: f64 = 0.5;

/// How bad a finding is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Severity {
    /// Nothing is said, because the data is in a format that is not read.
    NotChecked,
    /// Worth knowing.
    Info,
    /// A picture may be wrong.
    Warning,
    /// A picture is wrong.
    Error,
}

impl fmt::Display for Severity {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(match self {
            Self::NotChecked => "not-checked",
            Self::Info => "info",
            Self::Warning => "warning",
            Self::Error => "error",
        })
    }
}
