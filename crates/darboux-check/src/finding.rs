//! [`Finding`]: one thing that is wrong, where, and the evidence.

use std::borrow::Cow;
use std::fmt;

use darboux_io::gltf::PrimitiveName;
use serde::Serialize;

use crate::code::Code;
use crate::severity::Severity;

/// Where a finding is. Everything is absent for a map that was checked alone.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
#[non_exhaustive]
pub struct Place {
    /// The primitive.
    #[serde(flatten)]
    pub primitive: Option<PrimitiveName>,
    /// The number of further primitives with the same data.
    pub same_as: usize,
    /// The index of the material.
    pub material: Option<usize>,
    /// The index of the image.
    pub image: Option<usize>,
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match (&self.primitive, self.image, self.material) {
            (Some(primitive), ..) => {
                primitive.fmt(f)?;
                if self.same_as > 0 { write!(f, " and {} with the same data", self.same_as) } else { Ok(()) }
            }
            (None, Some(image), Some(material)) => {
                write!(f, "images[{image}] (normalTexture of materials[{material}])")
            }
            (None, Some(image), None) => write!(f, "images[{image}]"),
            (None, None, Some(material)) => write!(f, "materials[{material}]"),
            (None, None, None) => f.write_str("the image"),
        }
    }
}

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
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Finding {
    /// The kind.
    pub code: Code,
    /// How bad it is here.
    pub severity: Severity,
    /// Where it is.
    #[serde(flatten)]
    pub place: Place,
    /// The number of vertices, corners, faces or texels that show it, as the text says; 1 for a property of the whole.
    pub count: usize,
    /// The indices of the first ones, in the order of the file; empty for a property of the whole.
    pub first: Vec<usize>,
    /// The numbers that support it.
    pub evidence: Vec<Evidence>,
    /// What is wrong here, in one sentence.
    pub text: String,
    /// The cure here: what the reader can do.
    pub cure: Cow<'static, str>,
    /// Why a repair leaves it, as a clause; none where [`fix_document`](crate::fix_document) or [`fix_map`](crate::fix_map) repairs it.
    pub left_because: Option<String>,
    /// Whether all corners that can be judged show it.
    #[serde(skip)]
    pub(crate) is_on_all_corners: bool,
    /// Whether it is about a part of an image only.
    #[serde(skip)]
    pub(crate) is_on_part_of_image: bool,
    /// Whether another mistake cancels it: bumps look right now.
    #[serde(skip)]
    pub(crate) is_cancelled: bool,
}

/// The most indices in [`Finding::first`].
const FIRST: usize = 8;

impl Finding {
    /// A finding about the whole of a place, with the code's usual severity.
    pub fn new(code: Code, text: impl Into<String>) -> Self {
        Self {
            code,
            severity: code.severity(),
            place: Place::default(),
            count: 1,
            first: Vec::new(),
            evidence: Vec::new(),
            text: text.into(),
            cure: code.cure().into(),
            left_because: code.left_because().map(str::to_owned),
            is_on_all_corners: false,
            is_on_part_of_image: false,
            is_cancelled: false,
        }
    }

    /// Whether it can be repaired.
    pub fn is_fixable(&self) -> bool {
        self.left_because.is_none()
    }

    /// Whether it is about the things that it lists, and not about the whole of its place.
    pub(crate) fn lists_items(&self) -> bool {
        !self.first.is_empty()
    }

    /// The same with a reason, if there is one, why a repair leaves it.
    #[must_use]
    pub fn with_obstacle(self, obstacle: Option<String>) -> Self {
        Self { left_because: self.left_because.or(obstacle), ..self }
    }

    /// The same with a number of things, and the first of them.
    #[must_use]
    pub fn with_items(mut self, items: &[usize]) -> Self {
        self.count = items.len();
        self.first = items.iter().copied().take(FIRST).collect();
        self
    }

    /// The same with a count.
    #[must_use]
    pub fn with_count(self, count: usize) -> Self {
        Self { count, ..self }
    }

    /// The same with another severity.
    #[must_use]
    pub fn with_severity(self, severity: Severity) -> Self {
        Self { severity, ..self }
    }

    /// The same with another cure than that of the code.
    #[must_use]
    pub fn with_cure(self, cure: impl Into<Cow<'static, str>>) -> Self {
        Self { cure: cure.into(), ..self }
    }

    /// The same with a number.
    #[must_use]
    pub fn with_evidence(mut self, what: &'static str, value: f64, unit: &'static str) -> Self {
        self.evidence.push(Evidence { what, value, unit });
        self
    }
}
