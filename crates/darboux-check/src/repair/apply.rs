//! Applies edits to a document.

mod attributes;
mod correction;
mod normals;
mod tangents;

use std::collections::BTreeMap;

use darboux_io::Error;
use darboux_io::gltf::{Document, PrimitiveName};

use super::options::FixOptions;
use super::outcome::Change;
use super::plan::{Action, Edit, Kept, WrongTangents};
use crate::instances::{Groups, Key, key};

/// Applies edits, each to its primitive and to all with the same data. Returns what was done to tangents.
pub fn apply(
    document: &mut Document,
    edits: &[Edit],
    options: &FixOptions,
) -> Result<BTreeMap<Key, Change>, Error> {
    let mut changes = BTreeMap::new();
    let groups = groups_of(document, edits);
    let of_edit = |edit: &Edit| {
        let names = groups.at(document, &edit.place);
        names.iter().map(|name| (key(name), edit.kept)).collect::<Vec<_>>()
    };
    let kept: BTreeMap<Key, Kept> = edits.iter().flat_map(of_edit).collect();
    let lost_tangents = normals::repair(document, edits, options)?;
    tangents::make(document, &lost_tangents, &kept, options)?;
    changes.extend(lost_tangents.iter().map(|name| (key(name), Change::RecomputedTangents)));
    let flipped = names(document, edits, |action| *action == Action::NegateSigns);
    tangents::change(document, &flipped, |[x, y, z, w]| [x, y, z, -w])?;
    let mut wrong: BTreeMap<Key, &WrongTangents> = BTreeMap::new();
    let groups = groups_of(document, edits);
    for edit in edits {
        if let Action::CorrectTangents(of_edit) = &edit.action {
            let of_edit: &WrongTangents = of_edit;
            wrong.extend(groups.at(document, &edit.place).iter().map(|name| (key(name), of_edit)));
        }
    }
    changes.extend(tangents::correct(document, &wrong, &kept, options)?);
    let made = names(document, edits, |action| *action == Action::MakeTangents);
    tangents::make(document, &made, &kept, options)?;
    changes.extend(made.iter().map(|name| (key(name), Change::RecomputedTangents)));
    Ok(changes)
}

/// The primitives of the edits with some actions.
fn names(document: &Document, edits: &[Edit], is_chosen: impl Fn(&Action) -> bool) -> Vec<PrimitiveName> {
    let groups = groups_of(document, edits);
    let chosen = edits.iter().filter(|edit| is_chosen(&edit.action));
    chosen.flat_map(|edit| groups.at(document, &edit.place)).collect()
}

/// The groups of primitives with the same data, in the document as it is now.
fn groups_of(document: &Document, edits: &[Edit]) -> Groups {
    Groups::of(document, edits.iter().map(|edit| &edit.place))
}
