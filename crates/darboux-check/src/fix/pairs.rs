//! Mistakes of a map and of a surface that cancel each other: bumps look right, and would be inverted if only one were repaired.

use std::collections::{BTreeMap, BTreeSet};

use darboux_io::Error;
use darboux_io::gltf::{Appearance, Document};

use super::options::FixOptions;
use crate::cancelling::Pair;
use crate::finding::Finding;
use crate::instances::{Key, key};

/// The primitives and images that are left because a part of such a pair is left, each with the reason.
#[derive(Debug, Default)]
pub struct LeftPairs {
    primitives: BTreeMap<Key, String>,
    images: BTreeMap<usize, String>,
}

impl LeftPairs {
    /// Finds them. `on_images` and `on_surfaces`: the findings of the document. Errors: invalid data of the materials.
    pub fn new(
        document: &Document,
        on_images: &[Finding],
        on_surfaces: &[Finding],
        options: &FixOptions,
    ) -> Result<Self, Error> {
        let mut left = Self::default();
        let of_images = grouped(on_images, |finding| finding.place.image);
        if of_images.is_empty() {
            return Ok(left);
        }
        let appearances = document.appearances()?;
        for (primitive, on_surface) in
            grouped(on_surfaces, |finding| finding.place.primitive.as_ref().map(key))
        {
            for image in normal_maps_of(document, &appearances, primitive) {
                let on_map = of_images.get(&image).map_or(&[][..], |findings| findings);
                let pair = Pair::of(on_map.iter().copied(), on_surface.iter().copied());
                let Some(reason) = pair.and_then(|pair| reason(pair, on_map, &on_surface, options)) else {
                    continue;
                };
                left.primitives.insert(primitive, reason.clone());
                left.images.insert(image, reason);
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

/// The findings by what `group` tells of them; those of which it tells nothing are left out.
fn grouped<G: Ord>(
    findings: &[Finding],
    group: impl Fn(&Finding) -> Option<G>,
) -> BTreeMap<G, Vec<&Finding>> {
    let mut groups: BTreeMap<G, Vec<&Finding>> = BTreeMap::new();
    for finding in findings {
        if let Some(group) = group(finding) {
            groups.entry(group).or_default().push(finding);
        }
    }
    groups
}

/// The images of the normal maps of a primitive, those of its variants included.
fn normal_maps_of(
    document: &Document,
    appearances: &[Appearance],
    (mesh, primitive): Key,
) -> BTreeSet<usize> {
    let materials = document.meshes()[mesh].primitives[primitive].materials();
    let used = materials.iter().filter_map(|&material| appearances.get(material));
    used.flat_map(Appearance::normal_maps).filter_map(|texture| texture.image).collect()
}

/// Why the mistakes of a pair are left; none where all of them are to be repaired.
fn reason(pair: &Pair, on_map: &[&Finding], on_surface: &[&Finding], options: &FixOptions) -> Option<String> {
    let mut of_pair = on_map.iter().chain(on_surface).filter(|finding| pair.contains(finding));
    let [map_mistake, surface_mistake] = pair.names;
    of_pair.any(|finding| !options.repairs(finding)).then(|| {
        format!(
            "{surface_mistake} and {map_mistake} cancel here, and one of them is left; repair both or none"
        )
    })
}
