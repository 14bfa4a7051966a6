//! Repairs the surfaces of a document, and takes back the repairs that do not help.

use std::collections::BTreeMap;

use darboux_io::Error;
use darboux_io::gltf::{Document, PrimitiveName};

use super::options::FixOptions;
use super::outcome::{FixedDocument, FixedFinding, is_same, outcome};
use super::pairs::LeftPairs;
use super::{normals, tangents};
use crate::check::check_surfaces;
use crate::code::{Code, Family};
use crate::finding::Finding;
use crate::instances::primitives_of;
use crate::severity::Severity;

/// A primitive by the indices of mesh and primitive.
type Key = (usize, usize);

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
        return Ok(work.finish(&Attempt::default()));
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

fn key(name: &PrimitiveName) -> Key {
    (name.mesh, name.primitive)
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

/// What one attempt came to.
#[derive(Default)]
struct Attempt {
    /// Whether anything was changed.
    is_changed: bool,
    /// The findings after normals were repaired and before tangents were.
    between: Vec<Finding>,
    /// The findings at the end.
    remaining: Vec<Finding>,
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
        Ok(findings)
    }

    /// Whether all signs w of a primitive are flipped, and nothing else is to be repaired about its tangents.
    fn is_only_sign(&self, finding: &Finding, all: &[Finding]) -> bool {
        let are_all = finding.evidence.iter().any(|number| number.unit == "%" && number.value == 100.0);
        let is_other_work = |other: &Finding| {
            let is_about_tangents = other.code.family() == Family::Tangents && other.code != finding.code;
            is_about_tangents && place(other) == place(finding) && self.is_wanted(other)
        };
        finding.code == Code::TangentSignFlipped && are_all && !all.iter().any(is_other_work)
    }

    /// Repairs normals, then signs that are all flipped, and then tangents.
    fn attempt(&self, document: &mut Document) -> Result<Attempt, Error> {
        let is_about_normals = |finding: &&Finding| finding.code.family() == Family::Normals;
        let is_wanted = |finding: &&Finding| self.is_wanted(finding);
        let of_normals: Vec<&Finding> =
            self.findings.iter().filter(is_about_normals).filter(is_wanted).collect();
        let mut between = self.findings.clone();
        if !of_normals.is_empty() {
            let without_tangents = normals::fix(document, &of_normals, self.options)?;
            tangents::make(document, &without_tangents, self.options)?;
            between = self.left.mark(self.check(document)?);
        }
        let with_flipped_signs: Vec<&Finding> =
            between.iter().filter(is_wanted).filter(|finding| self.is_only_sign(finding, &between)).collect();
        let are_signs_negated = !with_flipped_signs.is_empty();
        let current = match are_signs_negated {
            true => {
                tangents::negate_signs(document, &with_flipped_signs)?;
                self.left.mark(self.check(document)?)
            }
            false => between.clone(),
        };
        let of_tangents: Vec<&Finding> =
            current.iter().filter(|finding| !is_about_normals(finding)).filter(is_wanted).collect();
        if !of_tangents.is_empty() {
            tangents::fix(document, &of_tangents, self.options)?;
        }
        let is_changed = !of_normals.is_empty() || are_signs_negated || !of_tangents.is_empty();
        let remaining = if is_changed { self.check(document)? } else { current.clone() };
        // What the new signs revealed is reported, too.
        let revealed = current.into_iter().filter(|new| !between.iter().any(|known| is_same(known, new)));
        let revealed: Vec<Finding> = revealed.collect();
        between.extend(revealed);
        Ok(Attempt { is_changed, between, remaining })
    }

    /// The primitives on which an attempt removed no finding, or ended in an error that was not there.
    fn refused_after(&self, attempt: &Attempt) -> Refused {
        let mut refused = Refused::new();
        let known = || self.findings.iter().chain(&attempt.between);
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
                let same = remaining().find(|left| left.code == wanted.code);
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

    /// What became of the findings, and of those that the repairs revealed.
    fn finish(self, attempt: &Attempt) -> FixedDocument {
        let revealed = attempt.between.iter();
        let revealed = revealed.chain(attempt.remaining.iter().filter(|left| left.severity > Severity::Info));
        let mut all: Vec<Finding> = self.findings.clone();
        for new in revealed {
            let is_known = |known: &Finding| known.code == new.code && place(known) == place(new);
            if !all.iter().any(is_known) {
                all.push(new.clone());
            }
        }
        let became = |finding: Finding| {
            let reason = place(&finding).and_then(|place| self.refused.get(&place)).cloned().flatten();
            match reason.filter(|_| self.options.repairs(&finding)) {
                Some(reason) => {
                    FixedFinding { finding: finding.with_obstacle(Some(reason)), repaired: false }
                }
                None => outcome(finding, &attempt.remaining, self.options),
            }
        };
        let findings = all.into_iter().map(became).collect();
        FixedDocument { findings, is_changed: attempt.is_changed }
    }
}
