//! The six ways in which handedness flips, each made alone, and the codes that name it.

use std::collections::BTreeSet;

use darboux_check::{CheckOptions, Code, Severity, check_document};

use super::maps::MAP_MISTAKES;
use super::models::Model;
use super::table::codes;

/// A way in which handedness flips.
pub struct Flip {
    pub name: &'static str,
    /// How it was made.
    pub how: &'static str,
    pub make: fn(&mut Model),
    /// The codes that name it.
    pub codes: &'static [Code],
}

/// All flips.
pub const FLIPS: &[Flip] = &[
    Flip {
        name: "sign of green",
        how: "green of the map inverted",
        make: |model| {
            let mistake = MAP_MISTAKES.iter().find(|mistake| mistake.code == Code::MapGreenFlipped);
            model.map = (mistake.expect("a mistake of that code").make)(&model.map);
        },
        codes: &[Code::MapGreenFlipped],
    },
    Flip {
        name: "sign w",
        how: "w of all tangents negated",
        make: |model| model.negate_signs(),
        codes: &[Code::TangentSignFlipped],
    },
    Flip {
        name: "UV winding",
        how: "u became 1 - u, the tangents stayed",
        make: |model| model.uvs[model.uv_set].iter_mut().for_each(|uv| uv[0] = 1.0 - uv[0]),
        codes: &[Code::TangentSignFlipped, Code::TangentNegated],
    },
    Flip {
        name: "UV origin",
        how: "v became 1 - v, the tangents stayed",
        make: |model| model.uvs[model.uv_set].iter_mut().for_each(|uv| uv[1] = 1.0 - uv[1]),
        codes: &[Code::TangentSignFlipped],
    },
    Flip {
        name: "front-face winding",
        how: "two corners of every face exchanged",
        make: Model::turn_faces,
        codes: &[Code::NormalAgainstWinding],
    },
    Flip {
        name: "handedness of space",
        how: "z of positions, normals and tangents negated",
        make: |model| {
            let normals = model.normals.iter_mut().flatten();
            model.positions.iter_mut().chain(normals).for_each(|vector| vector[2] = -vector[2]);
            model.tangents().iter_mut().for_each(|tangent| tangent[2] = -tangent[2]);
        },
        codes: &[Code::TangentSignFlipped, Code::NormalAgainstWinding],
    },
];

/// What the check names after a flip.
pub fn named(flip: &Flip, healthy: &Model) -> BTreeSet<Code> {
    let mut model = healthy.clone();
    (flip.make)(&mut model);
    let findings = check_document(&model.document(), &CheckOptions::default());
    codes(&findings.expect("a valid document"), |severity| severity > Severity::Info)
}
