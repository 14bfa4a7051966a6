//! Repairs the surfaces of a document, and takes back the repairs that do not help.

use std::collections::{BTreeMap, BTreeSet};

use darboux_io::Error;
use darboux_io::gltf::{Document, PrimitiveName};

use super::correction::is_about_single_tangents;
use super::options::FixOptions;
use super::outcome::{Change, FixedDocument, FixedFinding, is_same, outcome};
use super::pairs::LeftPairs;
use super::{normals, tangents};
use crate::check::check_surfaces;
use crate::code::{Code, Family};
use crate::finding::Finding;
use crate::instances::{Key, key, primitives_of};
use crate::severity::Severity;

/// The primitives whose repair is taken back, each with the reason if it is more than that the findings are still there.
type Refused = BTreeMap<Key, Option<String>>;

/// Repairs normals and tangents, but those in `left`.
pub fn fix_surfaces(
    document: &mut Document,
    findings: Vec<Finding>,
    left: &LeftPairs,
    options: &FixOptions,
) -> Result<FixedDocument, Error> {
    let mut work = Work { findings, groups: BTreeMap::new(), left, options, refused: Refused::new() };
    if !work.findings.iter().any(|finding| options.repairs(finding)) {
        let attempt = Attempt::new(&work.findings);
        return Ok(work.finish(&attempt));
    }
    document.decompress()?;
    for finding in work.findings.iter().filter(|finding| finding.place.same_as > 0) {
        let members = primitives_of(document, finding);
        work.groups.extend(members.iter().map(key).zip(finding.place.primitive.iter().cycle().cloned()));
    }
    // Every turn refuses the repair of one more primitive at least.
    loop {
        let checkpoint = document.checkpoint();
        let attempt = work.attempt(document)?;
        let refused = work.refused_after(&attempt);
        if refused.is_empty() {
            return Ok(work.finish(&attempt));
        }
        work.refused.extend(refused);
        document.roll_back(checkpoint);
    }
}

fn is_about_normals(finding: &Finding) -> bool {
    finding.code.family() == Family::Normals
}

/// The place of a finding on a surface.
fn place(finding: &Finding) -> Option<Key> {
    finding.place.primitive.as_ref().map(key)
}

struct Work<'a> {
    /// What is to be repaired.
    findings: Vec<Finding>,
    /// Primitives with the same data, each with the one that findings name.
    groups: BTreeMap<Key, PrimitiveName>,
    left: &'a LeftPairs,
    options: &'a FixOptions,
    refused: Refused,
}

/// Why a finding is left whose place was corrected as far as single tangents can be.
const KEPT: &str = "the rest needs all tangents computed again, and those of this recipe are kept";

/// What one attempt came to.
#[derive(Default)]
struct Attempt {
    /// Whether anything was changed.
    is_changed: bool,
    /// All findings that were there before, between or after its steps, each once.
    known: Vec<Finding>,
    /// The findings at the end.
    remaining: Vec<Finding>,
    /// The primitives whose tangents were corrected, and are not all made again to repair the rest.
    kept: BTreeSet<Key>,
    /// What was done to tangents.
    changes: BTreeMap<Key, Change>,
}

impl Attempt {
    fn new(findings: &[Finding]) -> Self {
        Self { known: findings.to_vec(), remaining: findings.to_vec(), ..Self::default() }
    }

    /// Notes the findings after a step.
    fn step(&mut self, mut remaining: Vec<Finding>) {
        // Repairs of surfaces change no findings about materials.
        remaining.extend(self.known.iter().filter(|finding| place(finding).is_none()).cloned());
        let revealed = remaining.iter().filter(|new| !self.known.iter().any(|known| is_same(known, new)));
        let revealed: Vec<Finding> = revealed.cloned().collect();
        self.known.extend(revealed);
        (self.is_changed, self.remaining) = (true, remaining);
    }
}

impl Work<'_> {
    fn is_wanted(&self, finding: &Finding) -> bool {
        let is_refused = place(finding).is_some_and(|place| self.refused.contains_key(&place));
        self.options.repairs(finding) && !is_refused
    }

    /// The findings on the surfaces as they are now. Those of a group are named by the primitive that named them before the repair.
    fn check(&self, document: &mut Document) -> Result<Vec<Finding>, Error> {
        let mut findings = check_surfaces(document)?;
        for named in findings.iter_mut().filter_map(|finding| finding.place.primitive.as_mut()) {
            if let Some(first) = self.groups.get(&key(named)) {
                *named = first.clone();
            }
        }
        Ok(self.left.mark(findings))
    }

    /// Whether all signs w of a primitive are flipped, and nothing else is to be repaired about its tangents.
    fn is_only_sign(&self, finding: &Finding, all: &[Finding]) -> bool {
        let is_other_work = |other: &Finding| {
            let is_about_tangents = other.code.family() == Family::Tangents && other.code != finding.code;
            is_about_tangents && place(other) == place(finding) && self.is_wanted(other)
        };
        finding.code == Code::TangentSignFlipped
            && finding.is_on_all_corners
            && !all.iter().any(is_other_work)
    }

    /// Repairs normals, then signs that are all flipped, then tangents that are wrong, and then all tangents of primitives where that is not enough.
    fn attempt(&self, document: &mut Document) -> Result<Attempt, Error> {
        let mut attempt = Attempt::new(&self.findings);
        let of_normals: Vec<&Finding> = self
            .findings
            .iter()
            .filter(|finding| is_about_normals(finding) && self.is_wanted(finding))
            .collect();
        if !of_normals.is_empty() {
            let without_tangents = normals::fix(document, &of_normals, self.options)?;
            tangents::make(document, &without_tangents, self.options)?;
            self.note_recomputed(&mut attempt, without_tangents.iter().map(key));
            attempt.step(self.check(document)?);
        }
        let flipped = self.of_tangents(&attempt, |finding, all| self.is_only_sign(finding, all));
        if !flipped.is_empty() {
            tangents::negate_signs(document, &flipped)?;
            attempt.step(self.check(document)?);
        }
        let wrong = self.of_tangents(&attempt, |finding, all| self.is_corrected(finding, all));
        let corrected: BTreeSet<Key> = wrong.iter().filter_map(place).collect();
        if !wrong.is_empty() {
            let changes = tangents::correct(document, &wrong, self.options)?;
            for (at, change) in changes {
                // What was computed again before was not kept.
                attempt.changes.entry(self.first_of(at)).or_insert(change);
            }
            attempt.step(self.check(document)?);
        }
        let is_kept = |finding: &Finding, all: &[Finding]| {
            place(finding).is_some_and(|at| corrected.contains(&at))
                && self.is_corrected(finding, all)
                && self.keeps_recipe(finding, all)
        };
        let kept = self.of_tangents(&attempt, is_kept);
        attempt.kept = kept.iter().filter_map(place).collect();
        let rest = self.of_tangents(&attempt, |finding, all| !is_kept(finding, all));
        if !rest.is_empty() {
            tangents::fix(document, &rest, self.options)?;
            self.note_recomputed(&mut attempt, rest.iter().filter_map(place));
            attempt.step(self.check(document)?);
        }
        Ok(attempt)
    }

    /// The primitive that names those with the same data.
    fn first_of(&self, at: Key) -> Key {
        self.groups.get(&at).map_or(at, key)
    }

    fn note_recomputed(&self, attempt: &mut Attempt, places: impl Iterator<Item = Key>) {
        attempt.changes.extend(places.map(|at| (self.first_of(at), Change::RecomputedTangents)));
    }

    /// Those of the remaining findings about anything but normals that are to be repaired and fulfil a condition.
    fn of_tangents(
        &self,
        attempt: &Attempt,
        condition: impl Fn(&Finding, &[Finding]) -> bool,
    ) -> Vec<Finding> {
        let all = &attempt.remaining;
        let is_chosen = |finding: &&Finding| {
            !is_about_normals(finding) && self.is_wanted(finding) && condition(finding, all)
        };
        all.iter().filter(is_chosen).cloned().collect()
    }

    /// Whether everything that is to be repaired about the tangents of a primitive is corrected one by one.
    fn is_corrected(&self, finding: &Finding, all: &[Finding]) -> bool {
        let is_other_work = |other: &Finding| {
            let is_about_tangents =
                other.code.family() == Family::Tangents && !is_about_single_tangents(other);
            is_about_tangents && place(other) == place(finding) && self.is_wanted(other)
        };
        !all.iter().any(is_other_work)
    }

    /// Whether the tangents of a primitive were computed in another way than MikkTSpace, and are to stay so.
    fn keeps_recipe(&self, finding: &Finding, all: &[Finding]) -> bool {
        let is_other = |other: &Finding| {
            other.code == Code::TangentOtherRecipe && place(other) == place(finding) && !self.is_wanted(other)
        };
        all.iter().any(is_other)
    }

    /// The primitives on which an attempt removed no finding, or ended in an error that was not there.
    fn refused_after(&self, attempt: &Attempt) -> Refused {
        let mut refused = Refused::new();
        let known = || attempt.known.iter();
        for at in known().filter(|finding| self.is_wanted(finding)).filter_map(place) {
            let is_here = |finding: &&Finding| place(finding) == Some(at);
            let remaining = || attempt.remaining.iter().filter(is_here);
            let is_new_error = |left: &&Finding| {
                let is_same_error =
                    |known: &Finding| known.code == left.code && known.severity == Severity::Error;
                left.severity == Severity::Error && !self.findings.iter().filter(is_here).any(is_same_error)
            };
            // With another method than MikkTSpace, tangents of another recipe may become those of the method that was asked for.
            let is_gone_or_other = |wanted: &Finding| {
                let same = remaining().find(|left| is_same(left, wanted));
                same.is_none_or(|left| {
                    self.options.asks_for_other_recipe() && left.evidence != wanted.evidence
                })
            };
            let mut wanted = known().filter(is_here).filter(|finding| self.is_wanted(finding));
            if let Some(worse) = remaining().find(is_new_error) {
                refused.insert(at, Some(format!("its repair would end in {}", worse.code)));
            } else if !wanted.any(is_gone_or_other) {
                refused.insert(at, None);
            }
        }
        refused
    }

    /// Why the place of a finding that was to be repaired is left, or a part of it is.
    fn reason(&self, finding: &Finding, attempt: &Attempt) -> Option<String> {
        let at = place(finding).filter(|_| self.options.repairs(finding))?;
        let refused = self.refused.get(&at).cloned().flatten();
        let remains = attempt.remaining.iter().any(|left| is_same(left, finding));
        refused.or_else(|| (remains && attempt.kept.contains(&at)).then(|| KEPT.to_owned()))
    }

    /// What became of the findings, and of those that the repairs revealed.
    fn finish(self, attempt: &Attempt) -> FixedDocument {
        // What is only worth knowing in the repaired file is not reported of the one that was given.
        let is_reported = |new: &&Finding| {
            let is_original = self.findings.iter().any(|known| is_same(known, new));
            let remains = attempt.remaining.iter().any(|left| is_same(left, new));
            is_original || !remains || new.severity > Severity::Info
        };
        let became = |finding: Finding| match self.reason(&finding, attempt) {
            Some(reason) => FixedFinding::left(finding, reason),
            None => {
                let is_about_tangents = finding.code.family() == Family::Tangents;
                let at = place(&finding).filter(|_| is_about_tangents);
                let change = at.and_then(|at| attempt.changes.get(&at).copied());
                let fixed = outcome(finding, &attempt.remaining, self.options);
                FixedFinding { change: change.filter(|_| fixed.repaired), ..fixed }
            }
        };
        let findings = attempt.known.iter().filter(is_reported).cloned().map(became).collect();
        FixedDocument { findings, is_changed: attempt.is_changed }
    }
}
