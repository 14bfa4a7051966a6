//! Cuts faces of four and more corners into triangles.
//!
//! A quad is cut where MikkTSpace cuts it: along its shorter diagonal in UV space, or in space where both are
//! equally long. A concave quad whose shorter diagonal lies outside is cut along the other one. Larger faces
//! are cut by a [`PolygonRule`]; docs/formats.md describes the rules.

mod alternating;
mod corner_tree;
mod ears;
mod queued;
mod triangle;

use darboux::Choice;
use darboux::internal::is_quad_cut_across;

use ears::Polygon;
pub use triangle::Triangle;

/// The most steps that the cuts of one file may take: tries of a corner, and nodes of the tree that a try
/// visits. A face of ordinary shape takes about a hundred per corner. What is left to cut when they are used
/// up has as many steps again, in an order that takes few ([`queued`]).
const MAX_STEPS: u64 = 1 << 26;

/// How faces of five and more corners are cut into triangles, which MikkTSpace needs. Quads are not affected.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum PolygonRule {
    /// As Blender cuts them for its exporters and for display.
    #[default]
    Blender,
    /// All triangles share the first corner; concave faces are cut into ears where that leaves fewer folds.
    Fan,
    /// Ears are cut off in the order of corners.
    Ears,
}

impl Choice for PolygonRule {
    const WHAT: &'static str = "polygon rule";
    const ALL: &'static [Self] = &[Self::Blender, Self::Fan, Self::Ears];

    fn name(self) -> &'static str {
        match self {
            Self::Blender => "blender",
            Self::Fan => "fan",
            Self::Ears => "ears",
        }
    }

    fn summary(self) -> &'static str {
        match self {
            Self::Blender => "as Blender cuts them for its exporters",
            Self::Fan => "all triangles share the first corner; concave faces are cut into ears",
            Self::Ears => "ears are cut off in the order of corners",
        }
    }
}

/// Cuts the faces of one file.
pub struct Cutter {
    rule: PolygonRule,
    steps: u64,
    /// The steps for faces that the rule did not cut.
    more_steps: u64,
    /// Concave quads that are not cut along the diagonal of MikkTSpace.
    pub outside_diagonals: usize,
    /// Faces with triangles that face the other way than the face: it crosses itself, or the steps are used
    /// up.
    pub folded: usize,
}

impl Cutter {
    pub fn new(rule: PolygonRule) -> Self {
        Self { rule, steps: MAX_STEPS, more_steps: MAX_STEPS, outside_diagonals: 0, folded: 0 }
    }

    /// The halves of a quad, in the order of MikkTSpace. `uvs`: none for a mesh without UVs, whose quads are
    /// cut from the first to the third corner.
    pub fn quad(&mut self, positions: &[[f32; 3]; 4], uvs: Option<[[f32; 2]; 4]>) -> [Triangle; 2] {
        const ALONG: [Triangle; 2] = [[0, 1, 2], [0, 2, 3]];
        const ACROSS: [Triangle; 2] = [[0, 1, 3], [1, 2, 3]];
        let is_across = uvs.is_some_and(|uvs| is_quad_cut_across(uvs, *positions));
        let (chosen, other) = if is_across { (ACROSS, ALONG) } else { (ALONG, ACROSS) };
        let wide = positions.map(|position| position.map(f64::from));
        let Some(polygon) = Polygon::of(&wide) else { return chosen };
        let faults = polygon.faults(&chosen);
        if faults == 0 {
            return chosen;
        }
        let is_other_better = polygon.faults(&other) < faults;
        self.outside_diagonals += usize::from(is_other_better && uvs.is_some());
        let halves = if is_other_better { other } else { chosen };
        self.folded += usize::from(polygon.is_folded(&halves));
        halves
    }

    /// The triangles of a face of five and more corners.
    pub fn polygon(&mut self, positions: &[[f32; 3]]) -> Vec<Triangle> {
        let wide: Vec<[f64; 3]> = positions.iter().map(|position| position.map(f64::from)).collect();
        let fan: Vec<Triangle> = fan(positions.len()).collect();
        let steps = &mut self.steps;
        let Some(polygon) = Polygon::of(&wide) else {
            return match self.rule {
                PolygonRule::Blender => alternating::cut(positions, steps).unwrap_or(fan),
                PolygonRule::Fan | PolygonRule::Ears => fan,
            };
        };
        let (mut triangles, is_used_up) = match self.rule {
            PolygonRule::Blender => match alternating::cut(positions, steps) {
                Some(triangles) => (triangles, false),
                None => (fan, true),
            },
            PolygonRule::Fan => (polygon.cut(fan, steps), *steps == 0),
            PolygonRule::Ears => (polygon.ears(steps).unwrap_or(fan), *steps == 0),
        };
        if is_used_up && polygon.is_folded(&triangles) {
            let queued = polygon.queued(&mut self.more_steps);
            triangles = queued.filter(|queued| !polygon.is_folded(queued)).unwrap_or(triangles);
        }
        self.folded += usize::from(polygon.is_folded(&triangles));
        triangles
    }
}

fn fan(corners: usize) -> impl Iterator<Item = Triangle> {
    (2..corners).map(|corner| [0, corner - 1, corner])
}
