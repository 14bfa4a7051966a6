//! The words of planned edits.

use super::counts::counted;
use crate::repair::plan::{Action, Flip};

/// What an edit does, as a clause.
pub fn clause(action: &Action) -> String {
    match action {
        Action::RepairNormals { turn, flip, make_unit, make } => {
            let turn = turn.map(|_| "turn the normals to the axes of the positions");
            let flip = flip.map(|flip| match flip {
                Flip::Faces => "flip the faces",
                Flip::Normals => "flip the normals",
            });
            let make_unit = make_unit.then_some("give the normals length 1");
            let make = make.then_some("make normals");
            [turn, flip, make_unit, make].into_iter().flatten().collect::<Vec<&str>>().join(", ")
        }
        Action::NegateSigns => "negate all signs w".to_owned(),
        Action::CorrectTangents(wrong) => {
            let codes: Vec<&str> = wrong.codes.iter().map(|code| code.name()).collect();
            let kinds = counted(codes.len(), "finding names", "findings name");
            format!("correct the tangents that {kinds} ({})", codes.join(", "))
        }
        Action::MakeTangents => "compute all tangents again".to_owned(),
    }
}
