//! [`plan`]: which edits repair defects.

use std::collections::{BTreeMap, BTreeSet};

use darboux::Method;

use super::options::FixOptions;
use crate::code::{Code, Family};
use crate::defect::{Defect, Fault, NormalFault, Obstacle, TangentFault};
use crate::hypotheses::{are_all_flipped, are_most_flipped, are_partly_flipped, needs_new_tangents};
use crate::indices::Indices;
use crate::instances::{Key, key};
use crate::measure::fit::Difference;
use crate::measure::other_axes::OtherAxes;
use crate::measure::reversal::Reversal;
use crate::place::Place;

/// A change of one primitive, and of all with the same data.
#[derive(Clone, Debug, PartialEq)]
pub struct Edit {
    pub place: Place,
    pub action: Action,
    pub kept: Kept,
}

/// What is true of all tangents of a primitive and stays so when they are computed again, because the map may
/// have been made for it or cancels it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Kept {
    /// The signs w stay flipped.
    pub flipped: bool,
    /// The tangents stay negated.
    pub negated: bool,
    /// The known method that made them makes them again.
    pub method: Option<Method>,
}

impl Kept {
    fn of(defects: &[&Defect], options: &FixOptions) -> Self {
        let left = || defects.iter().filter(|defect| !options.repairs(defect));
        let is_negated = |defect: &&&Defect| defect.code() == Code::TangentNegated && !defect.lists_items();
        Self {
            flipped: left().any(|defect| are_all_flipped(defect)),
            negated: left().any(|defect| is_negated(&defect)),
            method: left().find_map(|defect| kept_method(defect)),
        }
    }
}

/// The known method of tangents that are left. One whose difference to MikkTSpace cannot be seen may change.
fn kept_method(defect: &Defect) -> Option<Method> {
    let Fault::Tangent(TangentFault::OtherRecipe { recognised, .. }) = &defect.fault else { return None };
    let recipe = recognised.other_method().filter(|recipe| !recipe.from_quads)?;
    (defect.obstacle != Some(Obstacle::DifferenceIsInvisible)).then_some(recipe.method)
}

/// What is changed.
#[derive(Clone, Debug, PartialEq)]
pub enum Action {
    /// Normals are turned to the axes of the positions, faces or normals are flipped, then normals get length
    /// 1, then missing normals are made.
    RepairNormals { turn: Option<OtherAxes>, flip: Option<Flip>, make_unit: bool, make: bool },
    /// All signs w are negated.
    NegateSigns,
    /// Tangents that are wrong one by one are corrected.
    CorrectTangents(Box<WrongTangents>),
    /// All tangents are computed again.
    MakeTangents,
}

/// What is flipped where faces and normals disagree.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Flip {
    Faces,
    Normals,
}

/// What is known about the tangents of a surface where some are wrong.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct WrongTangents {
    /// The codes that are repaired.
    pub codes: BTreeSet<Code>,
    /// The vertices whose tangents lean, are outliers, or are rotated.
    pub leaning: Indices,
    pub outliers: Indices,
    pub rotated: Indices,
    /// The vertices whose tangents are negated, or where most are, the others.
    pub negated: Negated,
    /// The triangles with both signs, and those whose signs are all flipped.
    pub mixed: Indices,
    pub flipped: Indices,
    /// Whether the signs of all or of most triangles of the surface are flipped.
    pub are_most_flipped: bool,
    pub reversal: Option<Reversal>,
}

impl WrongTangents {
    /// The same with vertices by their places among some of the file, given by their ascending indices.
    pub fn among(&self, vertices: &[u32]) -> Self {
        Self {
            leaning: self.leaning.places_in(vertices),
            outliers: self.outliers.places_in(vertices),
            rotated: self.rotated.places_in(vertices),
            negated: match &self.negated {
                Negated::None => Negated::None,
                Negated::Only(negated) => Negated::Only(negated.places_in(vertices)),
                Negated::AllBut(others) => Negated::AllBut(others.places_in(vertices)),
            },
            ..self.clone()
        }
    }
}

/// The vertices whose tangents are negated.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum Negated {
    #[default]
    None,
    Only(Indices),
    AllBut(Indices),
}

impl Negated {
    pub fn contains(&self, vertex: usize) -> bool {
        match self {
            Self::None => false,
            Self::Only(vertices) => vertices.contains(vertex),
            Self::AllBut(vertices) => !vertices.contains(vertex),
        }
    }
}

impl Action {
    /// The stage after which the action is not planned again.
    pub fn stage(&self) -> Stage {
        match self {
            Self::RepairNormals { .. } => Stage::Normals,
            Self::NegateSigns => Stage::Signs,
            Self::CorrectTangents(_) => Stage::Corrected,
            Self::MakeTangents => Stage::Made,
        }
    }
}

/// How far the repair of a primitive is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub enum Stage {
    #[default]
    Start,
    Normals,
    Signs,
    Corrected,
    Made,
    /// Nothing more is planned.
    Refused,
}

/// The primitive of a defect.
pub fn place_of(defect: &Defect) -> Option<Key> {
    defect.place.primitive.as_ref().map(key)
}

/// The next edit of each primitive with defects that are to be repaired.
pub fn plan(defects: &[Defect], options: &FixOptions, stages: &BTreeMap<Key, Stage>) -> Vec<Edit> {
    let mut of_places: BTreeMap<Key, Vec<&Defect>> = BTreeMap::new();
    for defect in defects {
        if let Some(at) = place_of(defect) {
            of_places.entry(at).or_default().push(defect);
        }
    }
    let edit = |(at, defects): (Key, Vec<&Defect>)| {
        let stage = stages.get(&at).copied().unwrap_or_default();
        let action = next_action(&defects, options, stage)?;
        Some(Edit { place: defects[0].place.clone(), action, kept: Kept::of(&defects, options) })
    };
    of_places.into_iter().filter_map(edit).collect()
}

/// The next action on one primitive.
fn next_action(defects: &[&Defect], options: &FixOptions, stage: Stage) -> Option<Action> {
    let wanted: Vec<&Defect> = defects.iter().copied().filter(|defect| options.repairs(defect)).collect();
    let (of_normals, of_tangents): (Vec<&Defect>, Vec<&Defect>) =
        wanted.into_iter().partition(|defect| defect.family() == Family::Normals);
    if !of_normals.is_empty() && stage < Stage::Normals {
        return Some(repair_of_normals(&of_normals));
    }
    if of_tangents.is_empty() {
        return None;
    }
    if stage < Stage::Signs && of_tangents.iter().all(|defect| is_about_all_signs(defect)) {
        return Some(Action::NegateSigns);
    }
    let are_single = of_tangents.iter().all(|defect| !needs_new_tangents(defect));
    if stage < Stage::Corrected && are_single {
        return Some(Action::CorrectTangents(Box::new(wrong_tangents(defects, &of_tangents))));
    }
    let is_kept = stage == Stage::Corrected && are_single && keeps_recipe(defects, options);
    let is_kept = is_kept || leaves_some_signs(defects, options);
    (stage < Stage::Made && !is_kept).then_some(Action::MakeTangents)
}

/// Whether flipped signs of a part are left, which new tangents would not have.
pub fn leaves_some_signs(defects: &[&Defect], options: &FixOptions) -> bool {
    defects.iter().any(|defect| are_partly_flipped(defect) && !options.repairs(defect))
}

fn repair_of_normals(defects: &[&Defect]) -> Action {
    let has = |code: Code| defects.iter().any(|defect| defect.code() == code);
    let flip = defects.iter().find_map(|defect| match defect.fault {
        Fault::Normal(NormalFault::Reversed { reversal, .. }) => match reversal {
            Reversal::Faces => Some(Flip::Faces),
            Reversal::Normals | Reversal::NormalsByTangents => Some(Flip::Normals),
            Reversal::Unknown(_) => None,
        },
        _ => None,
    });
    let turn = defects.iter().find_map(|defect| match defect.fault {
        Fault::Normal(NormalFault::OtherAxes { axes, .. }) => Some(axes),
        _ => None,
    });
    let make_unit = has(Code::NormalNotFinite) || has(Code::NormalNotUnit);
    Action::RepairNormals { turn, flip, make_unit, make: has(Code::NormalMissing) }
}

/// Whether a defect says that all signs w of a primitive are flipped.
fn is_about_all_signs(defect: &Defect) -> bool {
    match &defect.fault {
        Fault::Tangent(TangentFault::Differs(found)) => {
            found.difference == Difference::SignFlipped && found.is_on_all_corners()
        }
        _ => false,
    }
}

/// Whether the tangents of a primitive were computed in another way than MikkTSpace, and the options want
/// them to stay so.
pub fn keeps_recipe(defects: &[&Defect], options: &FixOptions) -> bool {
    let is_recipe = |defect: &&Defect| defect.code() == Code::TangentOtherRecipe;
    defects.iter().any(is_recipe) && !options.chooses(Code::TangentOtherRecipe)
}

/// What all defects of a primitive say about its tangents. `wanted`: those that are to be repaired.
fn wrong_tangents(defects: &[&Defect], wanted: &[&Defect]) -> WrongTangents {
    let mut wrong =
        WrongTangents { codes: wanted.iter().map(|defect| defect.code()).collect(), ..Default::default() };
    for defect in defects {
        match &defect.fault {
            Fault::Tangent(TangentFault::Leaning { vertices, .. }) => wrong.leaning = vertices.clone(),
            Fault::Tangent(TangentFault::Outliers { vertices, .. }) => {
                wrong.outliers = vertices.items.clone()
            }
            Fault::Tangent(TangentFault::SignMixed(triangles)) => wrong.mixed = triangles.items.clone(),
            Fault::Normal(NormalFault::Reversed { reversal, .. }) => wrong.reversal = Some(*reversal),
            Fault::Tangent(TangentFault::Differs(found)) => match found.difference {
                Difference::PartlyRotated => wrong.rotated = found.items.clone(),
                Difference::PartlyNegated => wrong.negated = Negated::Only(found.items.clone()),
                Difference::Negated => wrong.negated = Negated::AllBut(found.exceptions.clone()),
                Difference::SignPartlyFlipped => wrong.flipped = found.items.clone(),
                _ => {}
            },
            _ => {}
        }
        wrong.are_most_flipped |= are_most_flipped(defect);
    }
    wrong
}
