//! Flipped signs w and flipped green in the normal map cancel each other: bumps look right, and would be inverted if only one were repaired.

use darboux_io::Error;
use darboux_io::gltf::{Document, PrimitiveName};

use super::options::FixOptions;
use crate::code::Code;
use crate::finding::Finding;

const REASON: &str =
    "flipped signs w and flipped green cancel here, and one of them is left; repair both or none";

/// The primitives and images that are left because of which one half of such a pair is left.
#[derive(Debug, Default)]
pub struct LeftPairs {
    primitives: Vec<PrimitiveName>,
    images: Vec<usize>,
}

impl LeftPairs {
    /// Finds them. `on_images` and `on_surfaces`: the findings of the document. Errors: invalid data of the materials.
    pub fn new(
        document: &Document,
        on_images: &[Finding],
        on_surfaces: &[Finding],
        options: &FixOptions,
    ) -> Result<Self, Error> {
        let appearances = document.appearances()?;
        let is_map_of = |material: usize, image: usize| {
            let appearance = appearances.get(material);
            appearance.is_some_and(|of| of.normal_maps().any(|texture| texture.image == Some(image)))
        };
        let mut left = Self::default();
        for signs in on_surfaces.iter().filter(|finding| finding.code == Code::TangentSignFlipped) {
            let is_of_these = |green: &&Finding| {
                let used = signs.place.material.zip(green.place.image);
                green.code == Code::MapGreenFlipped
                    && used.is_some_and(|(material, image)| is_map_of(material, image))
            };
            for green in on_images.iter().filter(is_of_these) {
                if !options.repairs(signs) || !options.repairs(green) {
                    left.primitives.extend(signs.place.primitive.clone());
                    left.images.extend(green.place.image);
                }
            }
        }
        Ok(left)
    }

    /// The findings, with the reason where they are left.
    pub fn mark(&self, findings: Vec<Finding>) -> Vec<Finding> {
        let is_left = |finding: &Finding| match (&finding.place.primitive, finding.place.image) {
            (Some(primitive), _) => self.primitives.contains(primitive),
            (None, Some(image)) => self.images.contains(&image),
            (None, None) => false,
        };
        let mark = |finding: Finding| {
            let reason = is_left(&finding).then(|| REASON.to_owned());
            finding.with_obstacle(reason)
        };
        findings.into_iter().map(mark).collect()
    }
}
