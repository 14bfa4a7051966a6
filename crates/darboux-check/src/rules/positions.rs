//! Rules about positions.

use super::rule::SurfaceRule;
use crate::defect::{Defect, Fault};
use crate::facts::SurfaceFacts;
use crate::measure::values::is_finite;

pub const RULES: &[SurfaceRule] = &[not_finite];

fn not_finite(facts: &SurfaceFacts<'_>) -> Vec<Defect> {
    let vertices = facts.surface.vertices_where(&facts.surface.positions, |position| !is_finite(*position));
    vertices.map(Fault::PositionNotFinite).map(Defect::new).into_iter().collect()
}
