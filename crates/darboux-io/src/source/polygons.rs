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

use darboux::choice;
use darboux::internal::is_quad_cut_across;

use ears::Polygon;
pub use triangle::Triangle;

/// The most steps that a rule may take for a face: tries of a corner, and nodes of the tree that a try
/// visits. A face of ordinary shape takes about a hundred per corner. What is left to cut when they are used
/// up has [steps of its own](queued_steps), in an order that takes few ([`queued`]).
///
/// They grow with the corners, so that time grows as slowly, and count for one face, so that no face changes
/// the triangles of another. Faces of up to 128 corners do not use them up, whatever their shape is: to find
/// an ear, each corner is tried at most once, which takes at most 63 steps, and passed over at most once.
fn rule_steps(corners: usize) -> u64 {
    512 * corners as u64 + (1 << 20)
}

/// The most steps for a face that the rule did not cut. An arch of 100,000 corners takes 607 per corner.
fn queued_steps(corners: usize) -> u64 {
    1024 * corners as u64 + (1 << 20)
}

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

choice! { PolygonRule, "polygon rule",
    Blender => "blender", "as Blender cuts them for its exporters";
    Fan => "fan", "all triangles share the first corner; concave faces are cut into ears";
    Ears => "ears", "ears are cut off in the order of corners";
}

/// Cuts the faces of one file.
pub struct Cutter {
    rule: PolygonRule,
    /// Concave quads that are not cut along the diagonal of MikkTSpace.
    pub outside_diagonals: usize,
    /// Faces with triangles that face the other way than the face: it crosses itself, is not flat, or the
    /// steps are used up.
    pub folded: usize,
}

impl Cutter {
    pub fn new(rule: PolygonRule) -> Self {
        Self { rule, outside_diagonals: 0, folded: 0 }
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
        let steps = &mut rule_steps(positions.len());
        let Some(polygon) = Polygon::of(&wide) else {
            return match self.rule {
                PolygonRule::Blender => alternating::cut(positions, steps).unwrap_or(fan),
                PolygonRule::Fan | PolygonRule::Ears => fan,
            };
        };
        let (mut triangles, is_kept) = match self.rule {
            // Blender's triangles fold on many faces that are not flat, and its exporters write them all the
            // same.
            PolygonRule::Blender => match alternating::cut(positions, steps) {
                Some(triangles) => (triangles, true),
                None => (fan, false),
            },
            PolygonRule::Fan => (polygon.cut(fan, steps), false),
            PolygonRule::Ears => (polygon.ears(steps).unwrap_or(fan), false),
        };
        if !is_kept && polygon.is_folded(&triangles) {
            let queued = polygon.queued(&mut queued_steps(positions.len()));
            triangles = queued.filter(|queued| !polygon.is_folded(queued)).unwrap_or(triangles);
        }
        self.folded += usize::from(polygon.is_folded(&triangles));
        triangles
    }
}

fn fan(corners: usize) -> impl Iterator<Item = Triangle> {
    (2..corners).map(|corner| [0, corner - 1, corner])
}

#[cfg(test)]
mod tests {
    use std::f32::consts::TAU;

    use darboux_dice::Dice;

    use super::*;

    fn random(corners: usize, dice: &mut Dice) -> Vec<[f32; 3]> {
        (0..corners).map(|_| [dice.below(10_000) as f32, dice.below(10_000) as f32, 0.0]).collect()
    }

    /// A face that crosses itself and has too many corners for its rule leaves the steps of others alone.
    #[test]
    fn no_face_changes_the_triangles_of_another() {
        let octagon: Vec<[f32; 3]> =
            (0..8).map(|i| (TAU * i as f32 / 8.0).sin_cos()).map(|(sin, cos)| [cos, sin, 0.0]).collect();
        let alone = Cutter::new(PolygonRule::Blender).polygon(&octagon);
        assert_ne!(alone, fan(8).collect::<Vec<_>>());
        let crossing = random(10_000, &mut Dice::from_seed(12));
        let mut cutter = Cutter::new(PolygonRule::Blender);
        assert_eq!(cutter.polygon(&crossing), fan(10_000).collect::<Vec<_>>());
        assert_eq!((cutter.polygon(&octagon), cutter.folded), (alone, 1));
    }

    #[test]
    fn small_faces_do_not_use_up_their_steps() {
        let mut dice = Dice::from_seed(13);
        for round in 0..200 {
            let face = random(128, &mut dice);
            let mut steps = rule_steps(128);
            assert!(alternating::cut(&face, &mut steps).is_some(), "round {round}");
            assert!(steps > rule_steps(128) / 2, "round {round}: {steps} steps are left");
        }
    }

    /// A zigzag band, for which both rules take steps in proportion to the square of its corners.
    #[test]
    fn faces_whose_steps_are_used_up_are_cut_without_folds() {
        let upper = (0..4000i16).map(|i| [f32::from(i), f32::from(i % 2) * 1000.0, 0.0]);
        let lower = upper.clone().map(|[x, y, z]| [x, y - 2.0, z]);
        let band: Vec<[f32; 3]> = lower.chain(upper.rev()).collect();
        for rule in [PolygonRule::Blender, PolygonRule::Ears, PolygonRule::Fan] {
            let mut cutter = Cutter::new(rule);
            let triangles = cutter.polygon(&band);
            assert_eq!(cutter.folded, 0, "{rule:?}");
            let polygon = Polygon::of(&band.iter().map(|p| p.map(f64::from)).collect::<Vec<_>>());
            let queued = polygon.and_then(|polygon| polygon.queued(&mut queued_steps(band.len())));
            assert_eq!(Some(triangles), queued, "{rule:?}");
        }
    }
}
