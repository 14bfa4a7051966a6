//! The words of defects: the one place that says them, for the command, Python and npm.

pub mod counts;
pub mod edits;
mod maps;
mod materials;
mod normals;
mod obstacles;
mod said;
mod tangents;
mod uvs;

use crate::defect::{Cancelled, Defect, Fault, Obstacle};
use crate::finding::Finding;
use crate::indices::Indices;
use said::Said;

/// The most indices in [`Finding::first`].
const FIRST: usize = 8;

/// The finding that says a defect.
pub fn finding(defect: Defect) -> Finding {
    let (code, fault) = (defect.code(), &defect.fault);
    let Said { mut text, evidence, cure } = said(fault, defect.severity).with_spoiled(defect.spoiled);
    if let Some(Obstacle::RedLikelier { image }) = defect.obstacle {
        text += &format!("; the red of images[{image}] is inverted, so that this may be likelier");
    }
    if let Some(Obstacle::MapMayCancel { .. }) = defect.obstacle {
        text += ", unless inverted green of the normal map cancels that";
    }
    if let Some(cancelled) = &defect.cancelled {
        text += &format!("; {}, so that bumps look right now: repair both or none", cancels(cancelled));
    }
    Finding {
        code,
        severity: defect.severity,
        place: defect.place.clone(),
        count: fault.count(),
        first: fault.items().into_iter().flat_map(Indices::iter).take(FIRST).collect(),
        evidence,
        text,
        cure: cure.unwrap_or(code.cure().into()),
        left_because: defect.obstacle.as_ref().map(obstacles::reason),
        defect,
    }
}

/// The findings that say defects.
pub fn findings(defects: Vec<Defect>) -> Vec<Finding> {
    defects.into_iter().map(finding).collect()
}

fn said(fault: &Fault, severity: crate::severity::Severity) -> Said {
    match fault {
        Fault::PositionNotFinite(_)
        | Fault::NormalMissing(_)
        | Fault::NormalNotFinite(_)
        | Fault::NormalNotUnit { .. }
        | Fault::NormalOtherAxes { .. }
        | Fault::NormalsReversed { .. }
        | Fault::NormalsPartlyReversed { .. } => normals::said(fault),
        Fault::UvMissing { .. }
        | Fault::UvNotFinite { .. }
        | Fault::UvDegenerate { .. }
        | Fault::UvMirrored(_)
        | Fault::UvOverlapping { .. } => uvs::said(fault),
        Fault::Map(fault) => maps::said(fault),
        Fault::TransformMirrors { .. } | Fault::MapScaleNegative(_) => materials::said(fault),
        _ => tangents::said(fault, severity),
    }
}

/// The mistake that cancels a defect, as a clause.
fn cancels(cancelled: &Cancelled) -> String {
    match cancelled {
        Cancelled::ByMap(pair) => {
            format!("the {} of the normal map cancels it", obstacles::names(pair)[0])
        }
        Cancelled::BySurface { pair, first, are_several } => {
            let place = first.as_ref().map_or(String::new(), ToString::to_string);
            let further = if *are_several { " and of all others that use the map" } else { "" };
            format!("the {} of {place}{further} cancel it", obstacles::names(pair)[1])
        }
    }
}
