//! Repairs the surfaces of a document, and takes back the repairs that do not help.

use std::collections::{BTreeMap, BTreeSet};

use darboux_io::Error;
use darboux_io::gltf::{Document, PrimitiveName};

use super::apply::apply;
use super::options::FixOptions;
use super::outcome::{Change, FixedDocument, FixedFinding, outcome};
use super::pairs::LeftPairs;
use super::plan::{Edit, Stage, keeps_recipe, leaves_some_signs, place_of, plan};
use crate::check::defects_of_surfaces;
use crate::code::{Code, Family};
use crate::defect::Defect;
use crate::defect::Obstacle;
use crate::hypotheses::needs_new_tangents;
use crate::instances::{Groups, Key, key};
use crate::model_area::ModelArea;
use crate::severity::Severity;

/// A repair that has not ended after so many rounds is taken as it is. Each round leaves fewer defects than
/// the one before.
const MAX_ROUNDS: usize = 16;

/// Repairs normals and tangents, but those in `left`.
pub fn fix_surfaces(
    document: &mut Document,
    defects: Vec<Defect>,
    left: &LeftPairs,
    options: &FixOptions,
) -> Result<FixedDocument, Error> {
    let mut work = Work { groups: BTreeMap::new(), area: ModelArea::of(document)?, left, options };
    let mut repair = Repair { after: defects.clone(), ..Repair::default() };
    if defects.iter().any(|defect| options.repairs(defect)) {
        work.name_groups(document, &defects);
    }
    for _ in 0..MAX_ROUNDS {
        if !work.round(document, &mut repair)? {
            break;
        }
    }
    let after = by_place(&repair.after);
    let findings = defects.into_iter().map(|defect| work.outcome(defect, &repair, &after)).collect();
    Ok(FixedDocument { findings, is_changed: repair.is_changed })
}

/// What the rounds of a repair came to.
#[derive(Default)]
struct Repair {
    is_changed: bool,
    /// The defects at the end.
    after: Vec<Defect>,
    /// What was done to tangents.
    changes: BTreeMap<Key, Change>,
    /// The primitives whose repair was taken back in the last round, each with the reason if it is more than
    /// that the defects are still there.
    refused: BTreeMap<Key, Option<Obstacle>>,
    /// The primitives whose tangents were corrected, and are not all made again to repair the rest.
    kept: BTreeSet<Key>,
    /// The primitives whose tangents may be computed again although the map may have been baked with them:
    /// the repair failed while they were kept.
    remade: BTreeSet<Key>,
}

/// What one attempt at a round came to.
#[derive(Default)]
struct Attempt {
    after: Vec<Defect>,
    changes: BTreeMap<Key, Change>,
    edited: BTreeSet<Key>,
    /// The primitives whose last edit was a correction of single tangents.
    corrected: BTreeSet<Key>,
}

struct Work<'a> {
    /// Primitives with the same data, each with the one that defects name.
    groups: BTreeMap<Key, PrimitiveName>,
    /// Repairs do not change it.
    area: ModelArea,
    left: &'a LeftPairs,
    options: &'a FixOptions,
}

impl Work<'_> {
    fn name_groups(&mut self, document: &Document, defects: &[Defect]) {
        let groups = Groups::of(document, defects.iter().map(|defect| &defect.place));
        // A primitive has several defects.
        let mut seen = BTreeSet::new();
        let is_first = |defect: &&Defect| place_of(defect).is_some_and(|at| seen.insert(at));
        for defect in defects.iter().filter(|defect| defect.place.same_as > 0).filter(is_first) {
            let members = groups.at(document, &defect.place);
            self.groups.extend(members.iter().map(key).zip(defect.place.primitive.iter().cycle().cloned()));
        }
    }

    /// The primitive that names those with the same data.
    fn first_of(&self, at: Key) -> Key {
        self.groups.get(&at).map_or(at, key)
    }

    /// One repair of everything that is to be repaired, without the edits that do not help. Returns whether
    /// anything was changed.
    fn round(&self, document: &mut Document, repair: &mut Repair) -> Result<bool, Error> {
        let mut refused = BTreeMap::new();
        // Every turn no longer keeps the tangents of one more primitive at least, or refuses its repair.
        loop {
            let checkpoint = document.checkpoint();
            let attempt = self.attempt(document, repair, &refused)?;
            let failed = self.refused_after(&repair.after, &attempt);
            if failed.is_empty() {
                repair.refused = refused;
                repair.is_changed |= !attempt.edited.is_empty();
                repair.kept = attempt.corrected;
                for (at, change) in attempt.changes {
                    let known = repair.changes.entry(at).or_insert(change);
                    *known = known.followed_by(change);
                }
                repair.after = attempt.after;
                return Ok(!attempt.edited.is_empty());
            }
            let kept = with_kept_tangents(repair.after.iter().chain(&attempt.after));
            let mut becomes_remade = |at: &Key| kept.contains(at) && repair.remade.insert(*at);
            refused.extend(failed.into_iter().filter(|(at, _)| !becomes_remade(at)));
            document.roll_back(checkpoint);
        }
    }

    /// Plans and applies edits until nothing more is planned.
    fn attempt(
        &self,
        document: &mut Document,
        repair: &Repair,
        refused: &BTreeMap<Key, Option<Obstacle>>,
    ) -> Result<Attempt, Error> {
        let mut stages: BTreeMap<Key, Stage> = refused.keys().map(|at| (*at, Stage::Refused)).collect();
        let mut attempt = Attempt { after: repair.after.clone(), ..Attempt::default() };
        let is_remade = |at: Key| repair.remade.contains(&at) && !refused.contains_key(&at);
        loop {
            for defect in &mut attempt.after {
                if is_of_kept_tangents(defect) && place_of(defect).is_some_and(is_remade) {
                    defect.obstacle = None;
                }
            }
            let edits = plan(&attempt.after, self.options, &stages);
            if edits.is_empty() {
                let corrected = stages.iter().filter(|(_, stage)| **stage == Stage::Corrected);
                attempt.corrected = corrected.map(|(at, _)| *at).collect();
                return Ok(attempt);
            }
            let changes = apply(document, &edits, self.options)?;
            for (at, change) in changes {
                // What was computed again before was not kept.
                let at = self.first_of(at);
                let known = attempt.changes.entry(at).or_insert(change);
                *known = known.followed_by(change);
            }
            let edited =
                |edit: &Edit| edit.place.primitive.as_ref().map(|name| (key(name), edit.action.stage()));
            let places: BTreeMap<Key, Stage> = edits.iter().filter_map(edited).collect();
            self.check_again(document, &mut attempt.after, &places)?;
            attempt.edited.extend(places.keys().copied());
            stages.extend(places);
        }
    }

    /// Measures the primitives again that were edited.
    fn check_again(
        &self,
        document: &mut Document,
        defects: &mut Vec<Defect>,
        edited: &BTreeMap<Key, Stage>,
    ) -> Result<(), Error> {
        let is_edited = |at: Key| edited.contains_key(&self.first_of(at));
        let mut found = defects_of_surfaces(document, &self.area, &|name| is_edited(key(name)))?;
        // The defects of a group are named by the primitive that named them before the repair.
        for named in found.iter_mut().filter_map(|defect| defect.place.primitive.as_mut()) {
            if let Some(first) = self.groups.get(&key(named)) {
                *named = first.clone();
            }
        }
        defects.retain(|defect| place_of(defect).is_none_or(|at| !is_edited(at)));
        defects.extend(self.left.mark(found));
        Ok(())
    }

    /// The primitives on which an attempt did not shrink the defects.
    fn refused_after(&self, before: &[Defect], attempt: &Attempt) -> BTreeMap<Key, Option<Obstacle>> {
        let (before, after) = (by_place(before), by_place(&attempt.after));
        let refusal = |&at: &Key| {
            let [before, after] =
                [&before, &after].map(|defects| defects.get(&Some(at)).map_or(&[][..], Vec::as_slice));
            if let Some(worse) = after.iter().find(|left| self.is_worse(left, before)) {
                return Some((at, Some(Obstacle::WouldEndIn(worse.code()))));
            }
            (!self.have_shrunk(before, after)).then_some((at, None))
        };
        attempt.edited.iter().filter_map(refusal).collect()
    }

    /// Whether fewer defects are to be repaired than before, or as many on fewer vertices or triangles. With
    /// another method than MikkTSpace, tangents of another recipe may also become tangents of the chosen
    /// method.
    fn have_shrunk(&self, before: &[&Defect], after: &[&Defect]) -> bool {
        let size = |defects: &[&Defect]| {
            let wanted: Vec<&&Defect> =
                defects.iter().filter(|defect| self.options.repairs(defect)).collect();
            (wanted.len(), wanted.iter().map(|defect| defect.fault.count()).sum::<usize>())
        };
        let is_recipe = |defect: &&&Defect| defect.code() == Code::TangentOtherRecipe;
        let recipe = |defects: &[&Defect]| defects.iter().find(is_recipe).map(|defect| defect.fault.clone());
        let has_other_recipe = || self.options.asks_for_other_method() && recipe(before) != recipe(after);
        size(after) < size(before) || has_other_recipe()
    }

    /// Whether a defect is worse than a remark, and was not there before as bad as it is. Tangents of another
    /// method are no defect where that method is asked for.
    fn is_worse(&self, left: &Defect, before: &[&Defect]) -> bool {
        if left.code() == Code::TangentOtherRecipe && self.options.asks_for_other_method() {
            return false;
        }
        let is_same = |known: &&&Defect| known.code() == left.code();
        // Beside larger ones it was no error, and these are gone.
        let damages_no_more = |known: &&Defect| {
            left.damaged_percent.zip(known.damaged_percent).is_some_and(|(left, known)| left <= known)
        };
        if before.iter().filter(is_same).any(damages_no_more) {
            return false;
        }
        let known = before.iter().filter(is_same).map(|known| known.severity).max();
        match left.severity {
            Severity::Error => known != Some(Severity::Error),
            _ => left.severity > Severity::Info && known.is_none(),
        }
    }

    /// What became of a defect. `after`: the defects at the end, by their primitives.
    fn outcome(
        &self,
        defect: Defect,
        repair: &Repair,
        after: &BTreeMap<Option<Key>, Vec<&Defect>>,
    ) -> FixedFinding {
        let of_place = after.get(&place_of(&defect)).map_or(&[][..], Vec::as_slice);
        let defect = with_later_severity(defect, of_place);
        let at = place_of(&defect).filter(|_| self.options.repairs(&defect));
        let remains = of_place.iter().any(|left| left.is_same(&defect));
        if let Some(at) = at.filter(|_| remains) {
            if let Some(Some(reason)) = repair.refused.get(&at) {
                return FixedFinding::left(defect, reason.clone());
            }
            if repair.kept.contains(&at) && keeps_recipe(of_place, self.options) {
                return FixedFinding::left(defect, Obstacle::RecipeIsKept);
            }
            if needs_new_tangents(&defect) && leaves_some_signs(of_place, self.options) {
                return FixedFinding::left(defect, Obstacle::SignsAreNotChosen);
            }
        }
        let is_about_tangents = defect.family() == Family::Tangents;
        let at = place_of(&defect).filter(|_| is_about_tangents);
        let change = at.and_then(|at| repair.changes.get(&at).copied());
        let fixed = outcome(defect, of_place.iter().copied(), self.options);
        FixedFinding { change: change.filter(|_| fixed.repaired), ..fixed }
    }
}

/// The defect with its severity after the repair, where that is higher: what cancelled it, or made it small,
/// may be gone. `after`: the defects of its place.
fn with_later_severity(defect: Defect, after: &[&Defect]) -> Defect {
    let is_cancelled = after.iter().any(|left| left.cancelled.is_some());
    let same = after.iter().find(|left| !is_cancelled && left.is_same(&defect));
    let severity = same.map_or(defect.severity, |same| defect.severity.max(same.severity));
    defect.with_severity(severity)
}

/// Whether a defect is about tangents that are kept because the map may have been baked with them.
fn is_of_kept_tangents(defect: &Defect) -> bool {
    defect.obstacle == Some(Obstacle::MapMayFitTangents)
}

/// The primitives with such tangents.
fn with_kept_tangents<'a>(defects: impl Iterator<Item = &'a Defect>) -> BTreeSet<Key> {
    defects.filter(|defect| is_of_kept_tangents(defect)).filter_map(place_of).collect()
}

/// The defects by their primitives; other defects have none.
fn by_place(defects: &[Defect]) -> BTreeMap<Option<Key>, Vec<&Defect>> {
    let mut places: BTreeMap<Option<Key>, Vec<&Defect>> = BTreeMap::new();
    for defect in defects {
        places.entry(place_of(defect)).or_default().push(defect);
    }
    places
}
