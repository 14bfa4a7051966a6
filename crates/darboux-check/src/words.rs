//! The words of defects: the one place that says them, for the command, Python and npm.

pub mod counts;
mod cures;
pub mod edits;
mod joint;
mod maps;
mod materials;
mod normals;
mod obstacles;
mod said;
mod tangents;
mod uvs;

use std::collections::HashMap;
use std::hash::Hash;

use crate::code::Code;
use crate::defect::{Cancelled, Defect, Fault, Obstacle, Unseen};
use crate::finding::Finding;
use crate::severity::Severity;
use said::Said;

/// The most indices in [`Finding::first`].
const FIRST: usize = 8;

/// The finding that says a defect.
pub fn finding(defect: Defect) -> Finding {
    of_group(vec![defect])
}

/// The finding that says one defect, or several of two conventions that cancel.
pub fn of_group(mut defects: Vec<Defect>) -> Finding {
    match defects.iter().position(|defect| matches!(defect.cancelled, Some(Cancelled::BySurface { .. }))) {
        Some(of_map) => {
            defects.swap(0, of_map);
            of_pair(defects)
        }
        None => single(defects.swap_remove(0)),
    }
}

/// One finding for all defects of a pair that cancels. The first defect is the map's.
fn of_pair(defects: Vec<Defect>) -> Finding {
    let code = Code::ConventionsCancel;
    let map = &defects[0];
    let of_map = defects.iter().filter(|defect| defect.place.primitive.is_none());
    let evidence = of_map.flat_map(|defect| said(&defect.fault, defect.severity).evidence);
    let left = defects.iter().find_map(|defect| defect.obstacle.as_ref());
    Finding {
        code,
        severity: defects.iter().map(|defect| defect.severity).fold(code.severity(), Severity::max),
        place: map.place.clone(),
        count: 1,
        first: Vec::new(),
        evidence: evidence.collect(),
        text: joint::text(map),
        cure: left.map_or(code.cure(), |_| cures::OF_PAIR).into(),
        left_because: left.map(obstacles::reason),
        defects,
    }
}

/// Why nothing shows a defect, as a clause.
fn unseen(why: Unseen) -> String {
    match why {
        Unseen::FlatMap { image } => format!("images[{image}], its normal map, is flat"),
        Unseen::NoMaterial => "its materials are unlit or scale the map by 0".to_owned(),
        Unseen::NotInScene => "no mesh of a node has it".to_owned(),
    }
}

fn single(defect: Defect) -> Finding {
    let (code, fault) = (defect.code(), &defect.fault);
    let Said { mut text, evidence, cure } =
        said(fault, defect.severity).with_damaged_percent(defect.damaged_percent, defect.family());
    if let Some(Obstacle::RedLikelier { image }) = defect.obstacle {
        text += &format!("; the red of images[{image}] is inverted, so that this may be likelier");
    }
    if let (Some(Obstacle::MapMayCancel { .. }), None) = (&defect.obstacle, &defect.cancelled) {
        text += ", unless inverted green of the normal map cancels that";
    }
    if let Some(why) = defect.unseen {
        text += &format!("; {}, so that nothing shows it", unseen(why));
    }
    if let Some(cancelled) = &defect.cancelled {
        text += &format!("; {}, so that bumps look right now: repair both or none", cancels(cancelled));
    }
    let cure = cure.unwrap_or(code.cure().into());
    let cure = cures::of_left(&defect).map_or(cure, Into::into);
    Finding {
        code,
        severity: defect.severity,
        place: defect.place.clone(),
        count: fault.count(),
        first: fault.items().into_iter().flat_map(|items| items.indices().iter()).take(FIRST).collect(),
        evidence,
        text,
        cure,
        left_because: defect.obstacle.as_ref().map(obstacles::reason),
        defects: vec![defect],
    }
}

/// The findings that say defects.
pub fn findings(defects: Vec<Defect>) -> Vec<Finding> {
    grouped(defects, Defect::joint).into_iter().map(of_group).collect()
}

/// The elements in groups of one key, each at the place of its first element; those without a key are alone.
pub fn grouped<T, K: Eq + Hash>(elements: Vec<T>, key: impl Fn(&T) -> Option<K>) -> Vec<Vec<T>> {
    let mut groups: Vec<Vec<T>> = Vec::new();
    let mut place_of_key = HashMap::new();
    for element in elements {
        let place = match key(&element) {
            Some(key) => *place_of_key.entry(key).or_insert(groups.len()),
            None => groups.len(),
        };
        match groups.get_mut(place) {
            Some(group) => group.push(element),
            None => groups.push(vec![element]),
        }
    }
    groups
}

fn said(fault: &Fault, severity: Severity) -> Said {
    match fault {
        Fault::PositionNotFinite(part) => normals::positions_not_finite(part),
        Fault::Normal(fault) => normals::said(fault),
        Fault::Uv(fault) => uvs::said(fault),
        Fault::Tangent(fault) => tangents::said(fault, severity),
        Fault::Map(fault) => maps::said(fault),
        Fault::Material(fault) => materials::said(fault),
    }
}

/// The mistake that cancels a defect, as a clause.
fn cancels(cancelled: &Cancelled) -> String {
    match cancelled {
        Cancelled::ByMap { pair, .. } => {
            format!("the {} of the normal map cancels it", obstacles::names(pair)[0])
        }
        Cancelled::BySurface { pair, first, are_several, .. } => {
            let place = first.as_ref().map_or(String::new(), ToString::to_string);
            let further = if *are_several { " and of all others that use the map" } else { "" };
            format!("the {} of {place}{further} cancel it", obstacles::names(pair)[1])
        }
    }
}
