//! Rules about positions.

use crate::code::Code;
use crate::finding::Finding;
use crate::rule::{Measured, SurfaceRule};
use crate::surface::indices_where;
use crate::text::counted;

pub const RULES: &[SurfaceRule] = &[not_finite];

fn not_finite(measured: &Measured<'_>) -> Vec<Finding> {
    let surface = measured.surface;
    let found = indices_where(&surface.positions, |position| !position.iter().all(|x| x.is_finite()));
    let found = surface.used(found);
    if found.is_empty() {
        return Vec::new();
    }
    let text = counted(found.len(), "position contains NaN or infinity", "positions contain NaN or infinity");
    let share = surface.percent_of_vertices(found.len());
    let finding = Finding::new(Code::PositionNotFinite, text).with_items(&found);
    vec![finding.with_evidence("part of all vertices", share, "%")]
}
