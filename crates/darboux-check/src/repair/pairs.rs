//! Mistakes of a map and of a surface that cancel each other: bumps look right, and would be inverted if only
//! one were repaired.

use std::collections::{BTreeMap, BTreeSet};

use darboux_io::Error;
use darboux_io::gltf::{Document, Material};

use super::options::FixOptions;
use super::plan::is_about_single_tangents;
use crate::cancelling::{is_part, pair_of};
use crate::code::{Code, Family};
use crate::defect::{Cancelled, Defect, Obstacle, PAIRS, Pair};
use crate::hypotheses::{ALL_PERCENT, flipped_percent, is_about_channels, is_about_signs};
use crate::instances::{Key, key};
use crate::severity::Severity;

/// The primitives and images that are left because a part of such a pair is left, each with the pair, or may
/// be one.
#[derive(Debug, Default)]
pub struct LeftPairs {
    primitives: BTreeMap<Key, &'static Pair>,
    images: BTreeMap<usize, &'static Pair>,
    /// The primitives and images of which a part cancels, so that their signs and channels are repaired
    /// together or not.
    partly: BTreeSet<Key>,
    partly_on: BTreeSet<usize>,
    /// The primitives whose flipped signs a map may cancel, each with that reason to leave them.
    may_cancel: BTreeMap<Key, Obstacle>,
    /// The primitives whose tangents nothing shows, each with its flat normal map.
    flat_maps: BTreeMap<Key, usize>,
    /// What cancels the defects of a code of a primitive.
    cancelled: BTreeMap<(Key, Code), Cancelled>,
}

impl LeftPairs {
    /// Finds them. `on_images` and `on_surfaces`: the defects of the document. Errors: invalid data of the
    /// materials.
    pub fn new(
        document: &Document,
        on_images: &[Defect],
        on_surfaces: &[Defect],
        options: &FixOptions,
    ) -> Result<Self, Error> {
        let may_cancel = |defect: &Defect| match (&defect.place.primitive, &defect.obstacle) {
            (Some(primitive), Some(obstacle @ Obstacle::MapMayCancel { .. })) => {
                Some((key(primitive), obstacle.clone()))
            }
            _ => None,
        };
        let may_cancel = on_surfaces.iter().filter_map(may_cancel).collect();
        let cancelled = |defect: &Defect| {
            Some(((key(defect.place.primitive.as_ref()?), defect.code()), defect.cancelled.clone()?))
        };
        let cancelled = on_surfaces.iter().filter_map(cancelled).collect();
        let flat_map = |defect: &Defect| Some((key(defect.place.primitive.as_ref()?), defect.flat_map?));
        let flat_maps = on_surfaces.iter().filter_map(flat_map).collect();
        let mut left = Self { may_cancel, cancelled, flat_maps, ..Self::default() };
        let of_images = grouped(on_images, |defect| defect.place.image);
        if of_images.is_empty() {
            return Ok(left);
        }
        let materials = document.materials()?;
        for (primitive, on_surface) in grouped(on_surfaces, |defect| defect.place.primitive.as_ref().map(key))
        {
            for image in normal_maps_of(document, &materials, primitive) {
                let on_map = of_images.get(&image).map_or(&[][..], |defects| defects);
                let pair = pair_of(on_map.iter().copied(), on_surface.iter().copied());
                if let Some(pair) = pair.filter(|pair| is_left(pair, on_map, &on_surface, options)) {
                    left.primitives.insert(primitive, pair);
                    left.images.insert(image, pair);
                } else if pair.is_none() && is_partly_left(on_map, &on_surface, options) {
                    left.partly.insert(primitive);
                    left.partly_on.insert(image);
                }
            }
        }
        Ok(left)
    }

    /// The defects, with the reason where they are left.
    pub fn mark(&self, defects: Vec<Defect>) -> Vec<Defect> {
        let defects: Vec<Defect> = defects.into_iter().map(|defect| self.marked(defect)).collect();
        let is_left = |defect: &&Defect| {
            defect.obstacle.is_some() && flipped_percent(defect).is_some_and(|percent| percent < ALL_PERCENT)
        };
        let kept: BTreeSet<Key> = defects.iter().filter(is_left).filter_map(primitive_of).collect();
        let mark = |defect: Defect| {
            let is_kept = primitive_of(&defect).is_some_and(|key| kept.contains(&key));
            let is_remade = defect.family() == Family::Tangents && !is_about_single_tangents(&defect);
            defect.with_obstacle((is_kept && is_remade).then_some(Obstacle::SignsAreLeft))
        };
        defects.into_iter().map(mark).collect()
    }

    fn marked(&self, mut defect: Defect) -> Defect {
        let pair_of = |defect: &Defect| match (&defect.place.primitive, defect.place.image) {
            (Some(primitive), _) => self.primitives.get(&key(primitive)).copied(),
            (None, Some(image)) => self.images.get(&image).copied(),
            (None, None) => None,
        };
        let may_cancel = |defect: &Defect| {
            let primitive = defect.place.primitive.as_ref().filter(|_| is_about_signs(defect))?;
            self.may_cancel.get(&key(primitive)).cloned()
        };
        let cancelled = |defect: &Defect| {
            let primitive = defect.place.primitive.as_ref()?;
            self.cancelled.get(&(key(primitive), defect.code())).cloned()
        };
        defect.cancelled = defect.cancelled.take().or_else(|| cancelled(&defect));
        // Other mistakes of the place are repaired, and the pair stays as it is.
        let pair = pair_of(&defect).filter(|pair| is_part(pair, &defect));
        let pair = pair.or_else(|| self.is_partly_left(&defect).then_some(&PAIRS[0]));
        let pair = pair.map(Obstacle::PairIsLeft);
        let map = may_cancel(&defect);
        if map.is_some() || defect.cancelled.is_some() {
            defect.severity = defect.severity.min(Severity::Warning);
        }
        let flat_map = defect.place.primitive.as_ref().and_then(|name| self.flat_maps.get(&key(name)));
        if let Some(&image) = flat_map {
            defect = defect.under_flat_map(image);
        }
        defect.with_obstacle(pair.or(map))
    }

    /// Whether signs or channels cancel on a part, and one of them is left.
    fn is_partly_left(&self, defect: &Defect) -> bool {
        let image = defect.place.image.filter(|_| is_about_channels(defect));
        let primitive = primitive_of(defect).filter(|_| is_about_signs(defect));
        image.is_some_and(|image| self.partly_on.contains(&image))
            || primitive.is_some_and(|key| self.partly.contains(&key))
    }
}

/// The defects by their group; defects without one are left out.
fn grouped<G: Ord>(defects: &[Defect], group: impl Fn(&Defect) -> Option<G>) -> BTreeMap<G, Vec<&Defect>> {
    let mut groups: BTreeMap<G, Vec<&Defect>> = BTreeMap::new();
    for defect in defects {
        if let Some(group) = group(defect) {
            groups.entry(group).or_default().push(defect);
        }
    }
    groups
}

/// The images of the normal maps of a primitive and its variants.
fn normal_maps_of(document: &Document, all: &[Material], (mesh, primitive): Key) -> BTreeSet<usize> {
    let materials = document.meshes()[mesh].primitives[primitive].materials();
    let used = materials.iter().filter_map(|&material| all.get(material));
    used.flat_map(Material::normal_maps).filter_map(|texture| texture.image).collect()
}

fn primitive_of(defect: &Defect) -> Option<Key> {
    defect.place.primitive.as_ref().map(key)
}

/// Whether signs of a surface and channels of its map are wrong, in other ways than as a pair, and one of
/// both is left: where signs are flipped, inverted channels look right.
fn is_partly_left(on_map: &[&Defect], on_surface: &[&Defect], options: &FixOptions) -> bool {
    let channels = || on_map.iter().filter(|defect| is_about_channels(defect));
    let signs = || on_surface.iter().filter(|defect| is_about_signs(defect));
    let are_both = channels().next().is_some() && signs().next().is_some();
    are_both && channels().chain(signs()).any(|defect| !options.repairs(defect))
}

/// Whether a mistake of a pair is left, so that none is repaired.
fn is_left(pair: &Pair, on_map: &[&Defect], on_surface: &[&Defect], options: &FixOptions) -> bool {
    let mut of_pair = on_map.iter().chain(on_surface).filter(|defect| is_part(pair, defect));
    of_pair.any(|defect| !options.repairs(defect))
}
