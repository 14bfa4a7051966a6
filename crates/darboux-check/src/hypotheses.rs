//! Which channels of a map are inverted: one space of hypotheses per map, with the likelihood of each from
//! all witnesses.
//!
//! ```text
//! witness                                   what it tells
//! the map's own derivatives                 whether an odd or an even number of channels is inverted
//! the faces, where the map was baked        which of the two that leaves
//! the signs w of the surfaces               a program that flips them often inverts green, too
//! another map of the model, by its faces    that this one was made by the same program
//! the user (`--assume`)                     what the derivatives leave open
//! ```
//!
//! A repair needs one hypothesis with 99 % at least. A mistake that is not identified is left: repairing one
//! of two mistakes that cancel makes a right picture wrong, and inverting green where red is inverted makes a
//! wrong picture worse.

use darboux::BitangentDirection;

use crate::check_options::CheckOptions;
use crate::code::Code;
use crate::defect::{Assumption, Defect, Fault, MapFault, Obstacle, TangentDifference, TangentFault};
use crate::inverted::{ALL, Inverted, relative};
use crate::measure::fit::Difference;
use crate::severity::{MIN_DAMAGED, Severity};

/// How often each is so on a model whose signs w are right, and on one where nearly all are flipped. None of
/// 264 published maps had its red inverted: one in a thousand is assumed. Of seven published models with
/// flipped signs, four had inverted green.
const PRIORS: [[f64; 4]; 2] = [[0.953, 0.045, 0.001, 0.001], [0.428, 0.57, 0.001, 0.001]];

/// How much likelier a map has the inversion that the faces show for another map of its model.
const SIBLING: f64 = 50.0;

/// The probability of a hypothesis that is repaired.
pub const IDENTIFIED: f64 = 0.99;

/// What the texels and the faces tell of a map; inverted is what is not as the options want it.
#[derive(Clone, Copy, Debug)]
pub struct MapWitness {
    /// The probability that an odd number of channels is inverted, as the derivatives show it; none where
    /// they do not.
    pub odd: Option<f64>,
    /// The logarithm of the odds that red is right, by the faces of the meshes; 0 where they do not decide.
    pub faces: f64,
    /// Whether the map is flat, so that no inversion matters.
    pub is_flat: bool,
    /// What the user says, where the derivatives permit it.
    pub assumed: Option<Inverted>,
}

impl MapWitness {
    /// A map that is not read.
    pub fn of_unread(options: &CheckOptions) -> Self {
        let assumed = options.assumed_map.map(|assumed| relative(assumed, options.green));
        Self { odd: None, faces: 0.0, is_flat: false, assumed }
    }

    /// The probabilities of the hypotheses in the order of [`ALL`].
    fn posterior(&self, are_signs_flipped: bool, sibling: Option<Inverted>) -> [f64; 4] {
        if self.is_flat {
            return [1.0, 0.0, 0.0, 0.0];
        }
        if let Some(assumed) = self.assumed.filter(|assumed| self.permits(*assumed)) {
            return ALL.map(|inverted| if inverted == assumed { 1.0 } else { 0.0 });
        }
        let prior = PRIORS[usize::from(are_signs_flipped)];
        // The logistic function of the odds, which does not overflow.
        let red_is_right = 1.0 / (1.0 + (-self.faces).exp());
        let likelihood = |index: usize| {
            let inverted = ALL[index];
            let is_red_right = matches!(inverted, Inverted::None | Inverted::Green);
            let by_faces = if is_red_right { red_is_right } else { 1.0 - red_is_right };
            let by_sibling = if sibling == Some(inverted) { SIBLING } else { 1.0 };
            prior[index] * by_faces * by_sibling
        };
        let mut weights: [f64; 4] = std::array::from_fn(likelihood);
        // The confidence of the derivatives was measured on real maps, so it replaces the prior of an odd
        // number.
        let odd = self.odd.unwrap_or(0.5);
        for (members, probability) in [([0, 3], 1.0 - odd), ([1, 2], odd)] {
            let sum: f64 = members.iter().map(|&index| weights[index]).sum();
            members.iter().for_each(|&index| weights[index] *= probability / sum);
        }
        weights
    }

    /// What becomes of the assumption beside flipped signs.
    fn assumption(&self) -> Assumption {
        match self.assumed {
            None => Assumption::None,
            Some(assumed) if !self.permits(assumed) => Assumption::Contradicted,
            Some(Inverted::Green) => Assumption::GreenInverted,
            Some(_) => Assumption::OtherInverted,
        }
    }

    /// Whether the derivatives do not contradict an assumption.
    fn permits(&self, assumed: Inverted) -> bool {
        const SURE: f64 = 0.9;
        let is_odd = matches!(assumed, Inverted::Green | Inverted::Red);
        self.odd.is_none_or(|odd| if is_odd { odd > 1.0 - SURE } else { odd < SURE })
    }
}

/// The channels that defects of a map call inverted.
pub fn inverted(on_map: &[Defect]) -> Inverted {
    let has = |code: Code| on_map.iter().any(|defect| is_about_channels(defect) && defect.code() == code);
    match (has(Code::MapRedFlipped), has(Code::MapGreenFlipped)) {
        (false, false) => Inverted::None,
        (false, true) => Inverted::Green,
        (true, false) => Inverted::Red,
        (true, true) => Inverted::Both,
    }
}

/// Whether a defect says that green of the whole map is inverted.
pub fn is_about_green(defect: &Defect) -> bool {
    matches!(defect.fault, Fault::Map(MapFault::GreenFlipped { .. }))
}

/// Whether the repair of a defect computes all tangents again, with the right signs.
pub fn needs_new_tangents(defect: &Defect) -> bool {
    matches!(&defect.fault, Fault::Tangent(fault) if !fault.is_about_single_tangents())
}

/// Whether the repair of a defect would also repair flipped signs of a part of the surface.
pub fn would_repair_signs(defect: &Defect) -> bool {
    needs_new_tangents(defect) || defect.code() == Code::TangentSignMixed
}

/// The largest severity of flipped signs, and of a map that they cancel. `damaged`: the part that looks
/// wrong, of all surfaces with that map, in percent of the model's area.
pub fn most_severe(damaged: f64) -> Severity {
    if damaged < MIN_DAMAGED { Severity::Warning } else { Severity::Error }
}

/// Whether a defect says that a channel of the whole map is inverted.
pub fn is_about_channels(defect: &Defect) -> bool {
    matches!(defect.fault, Fault::Map(MapFault::GreenFlipped { .. } | MapFault::RedFlipped(_)))
}

/// The flipped share of a surface, in percent, from which on a map that cancels it makes the picture right.
const NEARLY_ALL: f64 = 80.0;

/// Whether the signs of all or nearly all of a surface are flipped: a map that cancels them makes the picture
/// right.
pub fn are_nearly_all_flipped(defect: &Defect) -> bool {
    flipped_percent(defect).is_some_and(|percent| percent >= NEARLY_ALL)
}

/// Whether the signs of most of a surface are flipped.
pub fn are_most_flipped(defect: &Defect) -> bool {
    flipped_percent(defect).is_some_and(|percent| percent > 50.0)
}

/// Whether signs of a surface are flipped, at least those of a part: a map that is inverted cancels them
/// there.
pub fn is_about_signs(defect: &Defect) -> bool {
    flipped_percent(defect).is_some()
}

/// Whether the signs of a whole surface are flipped, but for errors.
pub fn are_all_flipped(defect: &Defect) -> bool {
    sign_difference(defect).is_some_and(|found| found.difference == Difference::SignFlipped)
}

/// Whether the signs of a part of a surface are flipped, and those of the rest are right.
pub fn are_partly_flipped(defect: &Defect) -> bool {
    is_about_signs(defect) && !are_all_flipped(defect)
}

/// The difference that a defect is about, if it is one of the signs of triangles.
fn sign_difference(defect: &Defect) -> Option<&TangentDifference> {
    let Fault::Tangent(TangentFault::Differs(found)) = &defect.fault else { return None };
    let is_of_signs = matches!(
        found.difference,
        Difference::SignFlipped | Difference::SignPartlyFlipped | Difference::SignFlippedWhereMirrored
    );
    is_of_signs.then_some(found)
}

/// What a defect calls flipped, in percent of the area that was measured; none for a defect that is not about
/// the signs of triangles.
fn flipped_percent(defect: &Defect) -> Option<f64> {
    let found = sign_difference(defect)?;
    Some(if are_all_flipped(defect) { 100.0 } else { found.flipped_percent })
}

/// In percent of the model's area: the part of surfaces with one map that looks wrong whether the map cancels
/// flipped signs or not: the smaller one of the part with flipped signs and the rest. `area`: of a surface by
/// its place in the list.
fn damaged_either_way(surfaces: &[Vec<&mut Defect>], area: &dyn Fn(usize) -> f64) -> f64 {
    let (mut flipped, mut rest) = (0.0, 0.0);
    for (index, surface) in surfaces.iter().enumerate() {
        let mut of_signs = surface.iter().filter(|defect| is_about_signs(defect)).peekable();
        if of_signs.peek().is_none() {
            rest += area(index);
        }
        for defect in of_signs {
            flipped += defect.damaged_percent.unwrap_or(0.0);
            rest += damaged_under_inverted_map(defect);
        }
    }
    f64::min(flipped, rest)
}

/// In percent of the model's area: the part without flipped signs, which looks wrong where a map cancels
/// flipped signs.
pub fn damaged_under_inverted_map(defect: &Defect) -> f64 {
    match (defect.damaged_percent, flipped_percent(defect)) {
        (Some(damaged), Some(percent)) if percent > 0.0 => damaged * (100.0 - percent).max(0.0) / percent,
        _ => 0.0,
    }
}

/// What is known about a map besides its texels and faces.
#[derive(Clone, Copy, Debug)]
pub struct MapContext {
    /// Where green should point.
    pub wanted: BitangentDirection,
    /// The image of the map; none for a map without a document.
    pub image: Option<usize>,
    /// Another image of the model and what the faces show of that image.
    pub sibling: Option<(usize, Inverted)>,
    /// Whether the model is from Sketchfab.
    pub is_from_sketchfab: bool,
}

impl MapContext {
    /// A map without a document.
    pub fn alone(options: &CheckOptions) -> Self {
        Self { wanted: options.green, image: None, sibling: None, is_from_sketchfab: false }
    }
}

/// Leaves what is not identified: inverted channels of a map, and flipped signs that the map may cancel.
/// `surfaces`: the defects of each surface that uses the map; `area`: of a surface, by its place in the list,
/// in percent of the model's.
pub fn leave_unidentified(
    on_map: &mut [Defect],
    witness: &MapWitness,
    surfaces: &mut [Vec<&mut Defect>],
    area: &dyn Fn(usize) -> f64,
    context: &MapContext,
) {
    let MapContext { wanted, image, sibling, is_from_sketchfab } = *context;
    leave_of_other_layout(on_map, surfaces, image);
    let is_flipped = |surface: &Vec<&mut Defect>| surface.iter().any(|defect| are_nearly_all_flipped(defect));
    let are_flipped = !surfaces.is_empty() && surfaces.iter().all(is_flipped);
    let found = inverted(on_map);
    let posterior = witness.posterior(are_flipped, sibling.map(|(_, inverted)| inverted));
    let probability = posterior[ALL.iter().position(|inverted| *inverted == found).unwrap_or(0)];
    if probability >= IDENTIFIED {
        return;
    }
    if found != Inverted::None {
        let obstacle = match sibling {
            Some((image, Inverted::Red)) if found == Inverted::Green => Obstacle::RedLikelier { image },
            _ => Obstacle::NotIdentified { probability, wanted },
        };
        for defect in on_map.iter_mut().filter(|defect| is_about_channels(defect)) {
            defect.leave(obstacle.clone());
        }
    }
    // Where the map is right after all, flipped signs are a mistake; where it is not, they cancel it.
    let most = most_severe(damaged_either_way(surfaces, area));
    for defect in surfaces.iter_mut().flatten().filter(|defect| is_about_signs(defect)) {
        let right = witness.odd.map(|_| posterior[0]);
        let assumption = witness.assumption();
        defect.leave(Obstacle::MapMayCancel { image, is_from_sketchfab, right, assumption, wanted });
        defect.severity = defect.severity.min(most);
    }
    for surface in surfaces {
        if surface.iter().any(|defect| are_partly_flipped(defect)) {
            for defect in surface.iter_mut().filter(|defect| would_repair_signs(defect)) {
                defect.leave(Obstacle::SignsAreLeft);
            }
        }
    }
}

/// Where a map was made for another UV layout, tangents that do not fit the UVs may fit the layout of the
/// map: the UVs were changed after the bake and the tangents kept. New ones would follow the wrong UVs.
fn leave_of_other_layout(on_map: &[Defect], surfaces: &mut [Vec<&mut Defect>], image: Option<usize>) {
    if !on_map.iter().any(|defect| defect.code() == Code::MapOtherLayout) {
        return;
    }
    for defect in surfaces.iter_mut().flatten().filter(|defect| follows_other_uvs(defect)) {
        defect.leave(Obstacle::MapHasOtherLayout { image });
        defect.severity = defect.severity.min(Severity::Warning);
    }
}

/// Whether tangents follow other UVs than the file's.
fn follows_other_uvs(defect: &Defect) -> bool {
    matches!(defect.fault, Fault::Tangent(TangentFault::Differs(_) | TangentFault::OtherRecipe { .. }))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn witness(odd: f64) -> MapWitness {
        MapWitness { odd: Some(odd), faces: 0.0, is_flat: false, assumed: None }
    }

    #[test]
    fn posteriors_are_distributions() {
        for odd in [0.0, 0.002, 0.5, 0.998, 1.0] {
            for faces in [-700.0, -6.0, 0.0, 6.0, 700.0] {
                for sibling in [None, Some(Inverted::Red), Some(Inverted::Green)] {
                    let posterior = MapWitness { faces, ..witness(odd) }.posterior(false, sibling);
                    assert!((posterior.iter().sum::<f64>() - 1.0).abs() < 1e-12, "{posterior:?}");
                }
            }
        }
    }

    /// What looks wrong on many surfaces with one map adds up: either the flipped parts, or the rest of them.
    #[test]
    fn the_damage_of_surfaces_with_one_map_adds_up() {
        let flipped = |flipped_percent: f64, damaged: f64| {
            let difference = TangentDifference {
                difference: Difference::SignPartlyFlipped,
                supporting: 1,
                measured: 2,
                items: (&[0][..]).into(),
                exceptions: (&[][..]).into(),
                flipped_percent,
                uv_set: 0,
                follows_from_normals: false,
            };
            Defect { damaged_percent: Some(damaged), ..Defect::new(TangentFault::Differs(difference)) }
        };
        // After them comes a surface with right signs.
        let beside = |mut defects: Vec<Defect>, right_area: f64| {
            let mut surfaces: Vec<Vec<&mut Defect>> = defects.iter_mut().map(|defect| vec![defect]).collect();
            surfaces.push(Vec::new());
            let options = CheckOptions::default();
            let witness = MapWitness::of_unread(&options);
            let context = MapContext::alone(&options);
            leave_unidentified(&mut [], &witness, &mut surfaces, &|_| right_area, &context);
            defects.iter().map(|defect| defect.severity).collect::<Vec<Severity>>()
        };
        let severities = |defects: Vec<Defect>| beside(defects, 0.0);
        let [error, warning] = [Severity::Error, Severity::Warning];
        assert_eq!(beside(vec![flipped(100.0, 40.0)], 0.4), [warning]);
        assert_eq!(beside(vec![flipped(100.0, 40.0)], 60.0), [error]);
        assert_eq!(severities(vec![flipped(50.0, 0.1); 4]), [warning; 4]);
        assert_eq!(severities(vec![flipped(50.0, 0.1); 5]), [error; 5]);
        // The first is right under an inverted map, the second under another one.
        assert_eq!(severities(vec![flipped(99.0, 40.0), flipped(1.0, 0.4)]), [error; 2]);
        assert_eq!(severities(vec![flipped(99.9, 40.0), flipped(99.0, 10.0)]), [warning; 2]);
    }

    /// Inverted red and green look alike to the derivatives: faces, another map, flipped signs and the user
    /// tell them apart.
    #[test]
    fn green_needs_a_second_witness() {
        let green = |witness: MapWitness, flipped, sibling| witness.posterior(flipped, sibling)[1];
        assert!(green(witness(0.998), false, None) < IDENTIFIED);
        assert!(green(MapWitness { faces: 6.0, ..witness(0.998) }, false, None) > IDENTIFIED);
        assert!(green(witness(0.998), false, Some(Inverted::Green)) > IDENTIFIED);
        assert!(green(witness(0.998), true, None) > IDENTIFIED);
        let assumed = MapWitness { assumed: Some(Inverted::Green), ..witness(0.998) };
        assert_eq!(green(assumed, false, None), 1.0);
        // What the derivatives are sure of is not overruled.
        assert!(green(MapWitness { odd: Some(0.002), ..assumed }, false, None) < 0.01);
    }
}
