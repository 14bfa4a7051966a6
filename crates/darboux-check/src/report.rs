//! [`ReportedFinding`]: a finding with the fields that the command's JSON, Python and npm give alike.

use std::cmp::Reverse;

use darboux_io::source::Provenance;
use serde::Serialize;

use crate::check_options::AssumedMap;
use crate::code::Code;
use crate::finding::{Evidence, Finding};
use crate::place::Place;
use crate::repair::{Change, FixedFinding};
use crate::severity::Severity;

/// A finding in one row: the place as indices, the words of its code, and what a repair did.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct ReportedFinding {
    /// The kind.
    pub code: Code,
    /// How bad it is here.
    pub severity: Severity,
    /// The place in words.
    #[serde(skip)]
    pub place: String,
    /// The index of the mesh.
    pub mesh: Option<usize>,
    /// The name of the mesh.
    pub mesh_name: Option<String>,
    /// The index of the primitive in the mesh.
    pub primitive: Option<usize>,
    /// The place of the primitive in the words of a file of another format than glTF, such as
    /// `Armature/Body in your FBX`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub source: Option<String>,
    /// The number of further primitives with the same data.
    pub same_as: usize,
    /// The index of the material.
    pub material: Option<usize>,
    /// The index of the image.
    pub image: Option<usize>,
    /// The number of vertices, corners, triangles or texels that show it, as the text says; 1 for a property
    /// of the whole.
    pub count: usize,
    /// The indices of the first ones, in the order of the file; empty for a property of the whole.
    pub first: Vec<usize>,
    /// What `first` numbers, where it has elements: `triangles` or `vertices`.
    pub first_are: &'static str,
    /// The numbers that support it.
    pub evidence: Vec<Evidence>,
    /// What is wrong here, in one sentence.
    pub text: String,
    /// What it looks like on screen.
    pub looks_like: &'static str,
    /// The cure here: what the reader can do.
    pub cure: String,
    /// Whether a repair could remove it before anything was repaired.
    pub fixable: bool,
    /// Why a repair leaves it, as a clause; none where it is repaired.
    pub left_because: Option<String>,
    /// What the user may say of the map so that a repair does not leave it.
    #[serde(skip)]
    pub(crate) suggested_assumption: Option<AssumedMap>,
    /// Whether it was repaired; none without a repair.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub repaired: Option<bool>,
    /// What the repair did to the tangents of the primitive.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub change: Option<Change>,
}

impl ReportedFinding {
    /// Whether a repair that has not run yet removes it.
    pub fn is_repairable(&self) -> bool {
        self.fixable && self.repaired.is_none()
    }

    /// Whether another finding says the same of another place, but for its numbers: the same kind, as severe,
    /// and repaired or left alike. Tangents of two methods are not the same.
    pub(crate) fn says_the_same(&self, other: &Self) -> bool {
        let kind = |finding: &Self| (finding.severity, finding.code, finding.left_because.is_some());
        let words = |finding: &Self| -> String {
            finding.text.chars().filter(|letter| !letter.is_ascii_digit()).collect()
        };
        kind(self) == kind(other) && (self.code != Code::TangentOtherRecipe || words(self) == words(other))
    }

    /// Names the place as a file of another format than glTF does, too: `Armature/Body in your FBX,
    /// meshes[1].primitives[0] "Body"`.
    pub(crate) fn name_place(&mut self, source: &Provenance) {
        self.source = self.mesh.zip(self.primitive).and_then(|(mesh, number)| source.place(mesh, number));
        if let Some(words) = &self.source {
            self.place = format!("{words}, {}", self.place);
        }
    }
}

/// The indices of findings that say the same of several places, together: the same kind, as severe, and
/// repaired or left alike. The most severe come first, and causes before what follows from them.
pub fn statements(findings: &[ReportedFinding]) -> Vec<Vec<usize>> {
    let mut sorted: Vec<usize> = (0..findings.len()).collect();
    sorted.sort_by_key(|&number| Reverse(findings[number].severity));
    let mut statements: Vec<Vec<usize>> = Vec::new();
    for number in sorted {
        let is_same = |same: &&mut Vec<usize>| findings[same[0]].says_the_same(&findings[number]);
        match statements.iter_mut().find(is_same) {
            Some(same) => same.push(number),
            None => statements.push(vec![number]),
        }
    }
    statements
}

impl From<Finding> for ReportedFinding {
    fn from(finding: Finding) -> Self {
        let place = finding.place.to_string();
        let (fixable, first_are) = (finding.is_fixable(), finding.first_are());
        let suggested_assumption = finding.suggested_assumption();
        let Place { primitive, same_as, material, image } = finding.place;
        let (mesh, number) =
            (primitive.as_ref().map(|name| name.mesh), primitive.as_ref().map(|name| name.primitive));
        Self {
            code: finding.code,
            severity: finding.severity,
            place,
            mesh,
            mesh_name: primitive.and_then(|name| name.shown_mesh_name()),
            primitive: number,
            source: None,
            same_as,
            material,
            image,
            count: finding.count,
            first: finding.first,
            first_are,
            evidence: finding.evidence,
            text: finding.text,
            looks_like: finding.code.looks_like(),
            cure: finding.cure.into_owned(),
            fixable,
            left_because: finding.left_because,
            suggested_assumption,
            repaired: None,
            change: None,
        }
    }
}

impl From<FixedFinding> for ReportedFinding {
    fn from(fixed: FixedFinding) -> Self {
        Self {
            repaired: Some(fixed.repaired),
            fixable: fixed.was_fixable(),
            change: fixed.change,
            ..fixed.finding.into()
        }
    }
}
