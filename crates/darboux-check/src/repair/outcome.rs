//! The results of repairs: each finding with whether it was repaired.

use std::collections::{HashMap, HashSet};

use serde::Serialize;

use super::options::FixOptions;
use crate::code::Code;
use crate::defect::Defect;
use crate::defect::Obstacle;
use crate::finding::Finding;
use crate::place::Place;
use crate::words;

/// What a repair did to the tangents of a primitive.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[non_exhaustive]
#[serde(tag = "kind", rename_all = "snake_case")]
pub enum Change {
    /// Some were corrected, and the others kept.
    CorrectedTangents {
        /// The number of vertices.
        count: usize,
    },
    /// All were computed again.
    RecomputedTangents,
}

impl Change {
    /// Two changes, one after the other. What was computed again was not kept.
    pub(super) fn followed_by(self, next: Self) -> Self {
        match (self, next) {
            (Self::CorrectedTangents { count }, Self::CorrectedTangents { count: more }) => {
                Self::CorrectedTangents { count: count.max(more) }
            }
            _ => Self::RecomputedTangents,
        }
    }
}

/// A finding and what became of it.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct FixedFinding {
    /// The finding before the repair; [`Finding::left_because`] says why it is still there.
    pub finding: Finding,
    /// Whether it is gone: repaired, or together with what was.
    pub repaired: bool,
    /// What was done to the tangents of its primitive; none for findings about anything else, and where only
    /// the signs w were negated.
    pub change: Option<Change>,
    pub(super) was_fixable: bool,
}

/// The result of [`fix_document`](crate::fix_document).
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct FixedDocument {
    /// The findings of the document before the repair, and those that the repair of a map revealed.
    pub findings: Vec<FixedFinding>,
    /// Whether a repair was kept. If none was, the document is written as it was.
    pub is_changed: bool,
}

impl FixedFinding {
    /// Whether the check said that a repair removes it, or the chosen codes have it removed.
    /// [`Finding::left_because`] says why one that is still there is.
    pub fn was_fixable(&self) -> bool {
        self.was_fixable
    }

    /// A defect that is no longer there.
    pub(super) fn gone(defect: Defect, change: Option<Change>) -> Self {
        let was_fixable = defect.is_fixable();
        let finding = words::finding(Defect { obstacle: None, ..defect });
        Self { was_fixable, repaired: true, change, finding }
    }

    /// The same at a place.
    pub(super) fn at(self, place: Place) -> Self {
        let at = |defect: Defect| Defect { place: place.clone(), ..defect };
        let defects = self.finding.defects.into_iter().map(at).collect();
        Self { finding: words::of_group(defects), ..self }
    }

    /// The same after a second repair, which found the defect again: `later` is what became of it.
    fn after_second(self, later: Self) -> Self {
        let was_fixable = self.was_fixable || later.was_fixable;
        let change = match (self.change, later.change) {
            (Some(first), Some(second)) => Some(first.followed_by(second)),
            (first, second) => second.or(first),
        };
        let finding = if self.repaired && later.repaired { self.finding } else { later.finding };
        Self { finding, repaired: later.repaired, change: change.filter(|_| later.repaired), was_fixable }
    }

    /// The same after a second repair, which did not find the defect again.
    fn not_found_again(self) -> Self {
        let Self { finding, change, was_fixable, .. } = self;
        let defects = finding.defects.into_iter().map(|defect| Defect { obstacle: None, ..defect }).collect();
        Self { finding: words::of_group(defects), repaired: true, change, was_fixable }
    }

    /// A defect that is still there. `reason`: why a defect that could have been repaired is left.
    pub(super) fn left(defect: Defect, reason: Obstacle) -> Self {
        let was_fixable = defect.is_fixable();
        let finding = words::finding(defect.with_obstacle(Some(reason)));
        Self { finding, repaired: false, change: None, was_fixable }
    }
}

/// What became of a defect. `remaining`: the defects after the repair.
pub fn outcome<'a>(
    defect: Defect,
    mut remaining: impl Iterator<Item = &'a Defect>,
    options: &FixOptions,
) -> FixedFinding {
    let Some(same) = remaining.find(|left| left.is_same(&defect)) else {
        return FixedFinding::gone(defect, None);
    };
    let is_recipe = defect.code() == Code::TangentOtherRecipe;
    let is_by_wanted_method = is_recipe && options.asks_for_other_method() && options.repairs(&defect);
    let reason = match options.left_because(same) {
        _ if is_by_wanted_method => Obstacle::OtherMethodWanted,
        Some(obstacle) => obstacle.clone(),
        None => Obstacle::NotRemoved,
    };
    FixedFinding::left(defect, reason)
}

/// The outcomes of two repairs, one after the other, of one defect each. What the second repair could not
/// remove is left. A defect that it did not find is gone. `is_hidden`: defects that its check cannot find,
/// for which the first repair decides.
pub fn of_both(
    first: Vec<FixedFinding>,
    second: Vec<FixedFinding>,
    is_hidden: impl Fn(&Defect) -> bool,
) -> Vec<FixedFinding> {
    let sameness = |fixed: &FixedFinding| fixed.finding.defects.first().map(Defect::sameness);
    let known: HashSet<_> = first.iter().map(sameness).collect();
    let (of_both, new): (Vec<FixedFinding>, Vec<FixedFinding>) =
        second.into_iter().partition(|later| known.contains(&sameness(later)));
    let later_of: HashMap<_, FixedFinding> =
        of_both.into_iter().map(|later| (sameness(&later), later)).collect();
    let followed = first.into_iter().map(|fixed| match later_of.get(&sameness(&fixed)) {
        Some(later) => fixed.after_second(later.clone()),
        None if fixed.finding.defects.iter().any(&is_hidden) => fixed,
        None => fixed.not_found_again(),
    });
    followed.chain(new).collect()
}

/// The outcomes. Defects that are one finding have one outcome: repaired where all are repaired.
pub fn joined(outcomes: Vec<FixedFinding>) -> Vec<FixedFinding> {
    let joint = |fixed: &FixedFinding| fixed.finding.defects.first().and_then(Defect::joint);
    words::grouped(outcomes, joint).into_iter().map(one).collect()
}

/// One outcome of a group.
fn one(mut group: Vec<FixedFinding>) -> FixedFinding {
    if group.len() == 1 {
        return group.remove(0);
    }
    let repaired = group.iter().all(|fixed| fixed.repaired);
    let was_fixable = group.iter().all(|fixed| fixed.was_fixable);
    let change = group.iter().find_map(|fixed| fixed.change);
    // What is left gives the reason, and what is gone has none.
    group.sort_by_key(|fixed| fixed.repaired);
    let defects = group.into_iter().flat_map(|fixed| fixed.finding.defects).collect();
    FixedFinding { finding: words::of_group(defects), repaired, change, was_fixable }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::defect::MapFault;

    /// What became of one defect in the first repair and in the second, which may not have found it.
    fn is_repaired(first: bool, second: Option<bool>, is_hidden: bool) -> Vec<bool> {
        let defect = || Defect::new(MapFault::Flat(100.0));
        let outcome = |repaired: bool| match repaired {
            true => FixedFinding::gone(defect(), None),
            false => FixedFinding::left(defect(), Obstacle::NotRemoved),
        };
        let both = of_both(vec![outcome(first)], second.map(outcome).into_iter().collect(), |_| is_hidden);
        both.iter().map(|fixed| fixed.repaired).collect()
    }

    #[test]
    fn what_the_second_repair_does_not_find_is_gone() {
        assert_eq!(is_repaired(false, None, false), [true]);
        assert_eq!(is_repaired(true, None, false), [true]);
        assert_eq!(is_repaired(false, None, true), [false]);
        let left = FixedFinding::left(Defect::new(MapFault::Flat(100.0)), Obstacle::NotRemoved);
        assert!(left.finding.left_because.is_some());
        let both = of_both(vec![left], Vec::new(), |_| false);
        assert_eq!(both[0].finding.left_because, None, "what is gone has no reason to be left");
    }

    #[test]
    fn what_the_second_repair_finds_is_as_it_says() {
        for first in [false, true] {
            for second in [false, true] {
                assert_eq!(is_repaired(first, Some(second), true), [second]);
            }
        }
    }
}
