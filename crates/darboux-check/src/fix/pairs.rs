//! Mistakes of a map and of a surface that cancel each other: bumps look right, and would be inverted if only one were repaired.

use std::collections::BTreeMap;

use darboux_io::Error;
use darboux_io::gltf::Document;

use super::options::FixOptions;
use crate::cancelling::Pair;
use crate::finding::Finding;
use crate::instances::{Key, key};
use crate::map_users::MapUsers;

/// The primitives and images that are left because a part of such a pair is left, each with the reason.
#[derive(Debug, Default)]
pub struct LeftPairs {
    primitives: BTreeMap<Key, String>,
    images: BTreeMap<usize, String>,
}

impl LeftPairs {
    /// Finds them. `on_images` and `on_surfaces`: the findings of the document. Errors: invalid data of the primitives.
    pub fn new(
        document: &Document,
        on_images: &[Finding],
        on_surfaces: &[Finding],
        options: &FixOptions,
    ) -> Result<Self, Error> {
        let mut left = Self::default();
        let mut of_images: BTreeMap<usize, Vec<&Finding>> = BTreeMap::new();
        for finding in on_images {
            let image = finding.place.image.into_iter();
            image.for_each(|image| of_images.entry(image).or_default().push(finding));
        }
        if of_images.is_empty() {
            return Ok(left);
        }
        let users = MapUsers::new(document, &document.appearances()?)?;
        for (image, on_map) in of_images {
            for name in users.names(image) {
                let is_there = |finding: &&Finding| finding.place.primitive.as_ref() == Some(name);
                let on_surface: Vec<&Finding> = on_surfaces.iter().filter(is_there).collect();
                let Some(pair) = Pair::of(on_map.iter().copied(), on_surface.iter().copied()) else {
                    continue;
                };
                let mut both = on_map.iter().chain(&on_surface).filter(|finding| pair.contains(finding));
                if both.any(|finding| !options.repairs(finding)) {
                    let reason = reason(pair);
                    left.primitives.insert(key(name), reason.clone());
                    left.images.insert(image, reason);
                }
            }
        }
        Ok(left)
    }

    /// The findings, with the reason where they are left.
    pub fn mark(&self, findings: Vec<Finding>) -> Vec<Finding> {
        let reason_of = |finding: &Finding| match (&finding.place.primitive, finding.place.image) {
            (Some(primitive), _) => self.primitives.get(&key(primitive)).cloned(),
            (None, Some(image)) => self.images.get(&image).cloned(),
            (None, None) => None,
        };
        let mark = |finding: Finding| {
            let reason = reason_of(&finding);
            finding.with_obstacle(reason)
        };
        findings.into_iter().map(mark).collect()
    }
}

fn reason(pair: &Pair) -> String {
    let [on_map, on_surface] = pair.names;
    format!("{on_surface} and {on_map} cancel here, and one of them is left; repair both or none")
}
