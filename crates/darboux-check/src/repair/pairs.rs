//! Mistakes of a map and of a surface that cancel each other: bumps look right, and would be inverted if only
//! one were repaired.

use std::collections::{BTreeMap, BTreeSet};

use darboux::internal::DisjointSets;
use darboux_io::Error;
use darboux_io::gltf::{Document, Material};

use super::options::FixOptions;
use crate::cancelling::{is_part, pair_of};
use crate::code::Code;
use crate::defect::{Cancelled, Defect, Obstacle, PAIRS, Pair, Unseen};
use crate::hypotheses::{are_partly_flipped, is_about_green, is_about_signs, would_repair_signs};
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
    /// The primitives whose flipped signs a map may cancel, each with that reason to leave them, and how bad
    /// they are.
    may_cancel: BTreeMap<Key, (Obstacle, Severity)>,
    /// The primitives whose tangents nothing shows, each with the reason.
    unseen: BTreeMap<Key, Unseen>,
    /// What cancels the defects of a code of a primitive, and how bad they are.
    cancelled: BTreeMap<(Key, Code), (Cancelled, Severity)>,
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
                Some((key(primitive), (obstacle.clone(), defect.severity)))
            }
            _ => None,
        };
        let may_cancel = on_surfaces.iter().filter_map(may_cancel).collect();
        let cancelled = |defect: &Defect| {
            let at = (key(defect.place.primitive.as_ref()?), defect.code());
            Some((at, (defect.cancelled.clone()?, defect.severity)))
        };
        let cancelled = on_surfaces.iter().filter_map(cancelled).collect();
        let unseen = |defect: &Defect| Some((key(defect.place.primitive.as_ref()?), defect.unseen?));
        let unseen = on_surfaces.iter().filter_map(unseen).collect();
        let mut left = Self { may_cancel, cancelled, unseen, ..Self::default() };
        let of_images = grouped(on_images, |defect| defect.place.image);
        if of_images.is_empty() {
            return Ok(left);
        }
        let materials = document.materials()?;
        let mut links = Vec::new();
        for (primitive, on_surface) in grouped(on_surfaces, primitive_of) {
            for image in normal_maps_of(document, &materials, primitive) {
                let on_map = of_images.get(&image).map_or(&[][..], |defects| defects);
                links.extend(Link::of((image, on_map), (primitive, &on_surface), options));
            }
        }
        for link in left_links(links) {
            match link.pair {
                Some(pair) => {
                    left.primitives.insert(link.primitive, pair);
                    left.images.insert(link.image, pair);
                }
                None => {
                    left.partly.insert(link.primitive);
                    left.partly_on.insert(link.image);
                }
            }
        }
        Ok(left)
    }

    /// The defects, with the reason where they are left.
    pub fn mark(&self, defects: Vec<Defect>) -> Vec<Defect> {
        with_signs_that_are_left(defects.into_iter().map(|defect| self.marked(defect)).collect())
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
        let cancelled = cancelled(&defect);
        let map = may_cancel(&defect);
        let known =
            cancelled.iter().map(|(_, severity)| severity).chain(map.iter().map(|(_, severity)| severity));
        defect.severity = known.fold(defect.severity, |severity, known| severity.min(*known));
        defect.cancelled = defect.cancelled.take().or(cancelled.map(|(cancelled, _)| cancelled));
        // Other mistakes of the place are repaired, and the pair stays as it is.
        let pair = pair_of(&defect).filter(|pair| is_part(pair, &defect));
        let pair = pair.or_else(|| self.is_partly_left(&defect).then_some(&PAIRS[0]));
        let pair = pair.map(Obstacle::PairIsLeft);
        let unseen = defect.place.primitive.as_ref().and_then(|name| self.unseen.get(&key(name)));
        if let Some(&why) = unseen {
            defect = defect.that_is_unseen(why);
        }
        defect.with_obstacle(pair.or(map.map(|(obstacle, _)| obstacle)))
    }

    /// Whether signs or channels cancel on a part, and one of them is left.
    fn is_partly_left(&self, defect: &Defect) -> bool {
        let image = defect.place.image.filter(|_| is_about_green(defect));
        let primitive = primitive_of(defect).filter(|_| is_about_signs(defect));
        image.is_some_and(|image| self.partly_on.contains(&image))
            || primitive.is_some_and(|key| self.partly.contains(&key))
    }
}

/// The defects, with the reason where flipped signs of a part of their primitive are left, which their repair
/// would repair, too.
fn with_signs_that_are_left(mut defects: Vec<Defect>) -> Vec<Defect> {
    let is_left = |defect: &&Defect| defect.obstacle.is_some() && are_partly_flipped(defect);
    let keep_signs: BTreeSet<Key> = defects.iter().filter(is_left).filter_map(primitive_of).collect();
    for defect in defects.iter_mut().filter(|defect| would_repair_signs(defect)) {
        if primitive_of(defect).is_some_and(|key| keep_signs.contains(&key)) {
            defect.leave(Obstacle::SignsAreLeft);
        }
    }
    defects
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

/// Mistakes of a map and of a surface that uses it, which are repaired together or not.
struct Link {
    image: usize,
    primitive: Key,
    /// None where they cancel on a part of the surface only.
    pair: Option<&'static Pair>,
    /// Whether one of the mistakes is not repaired.
    is_left: bool,
}

impl Link {
    /// None where nothing of both cancels.
    fn of(
        (image, on_map): (usize, &[&Defect]),
        (primitive, on_surface): (Key, &[&Defect]),
        options: &FixOptions,
    ) -> Option<Self> {
        let pair = pair_of(on_map.iter().copied(), on_surface.iter().copied());
        let is_left = match pair {
            Some(pair) => is_left(pair, on_map, on_surface, options),
            None => is_partly_left(on_map, on_surface, options)?,
        };
        Some(Self { image, primitive, pair, is_left })
    }
}

/// The links of which a mistake is left, or that share a map or a surface with such links.
fn left_links(links: Vec<Link>) -> Vec<Link> {
    let primitives: BTreeSet<Key> = links.iter().map(|link| link.primitive).collect();
    let primitives: BTreeMap<Key, usize> = primitives.into_iter().zip(0..).collect();
    let images: BTreeSet<usize> = links.iter().map(|link| link.image).collect();
    let images: BTreeMap<usize, usize> = images.into_iter().zip(primitives.len()..).collect();
    let mut groups = DisjointSets::new(primitives.len() + images.len());
    links.iter().for_each(|link| groups.join(primitives[&link.primitive], images[&link.image]));
    let mut group = |link: &Link| groups.name(primitives[&link.primitive]);
    let left: BTreeSet<usize> = links.iter().filter(|link| link.is_left).map(&mut group).collect();
    links.into_iter().filter(|link| left.contains(&group(link))).collect()
}

/// Whether green of a map, or signs of a part of a surface that uses it, are left: where signs are flipped,
/// inverted green looks right. None where not both are wrong.
fn is_partly_left(on_map: &[&Defect], on_surface: &[&Defect], options: &FixOptions) -> Option<bool> {
    let green = || on_map.iter().filter(|defect| is_about_green(defect));
    let signs = || on_surface.iter().filter(|defect| is_about_signs(defect));
    let are_both = green().next().is_some() && signs().next().is_some();
    are_both.then(|| {
        leaves_inverted_red(on_map.iter().copied(), options)
            || green().chain(signs()).any(|defect| !options.repairs(defect))
    })
}

/// Whether the inverted red of a map is left, so that nothing of the map is repaired: once it is known, only
/// that is certain of the channels.
pub fn leaves_inverted_red<'a>(on_map: impl IntoIterator<Item = &'a Defect>, options: &FixOptions) -> bool {
    on_map.into_iter().any(|defect| defect.code() == Code::MapRedFlipped && !options.repairs(defect))
}

/// Whether a mistake of a pair is left, so that none is repaired.
fn is_left(pair: &Pair, on_map: &[&Defect], on_surface: &[&Defect], options: &FixOptions) -> bool {
    let mut of_pair = on_map.iter().chain(on_surface).filter(|defect| is_part(pair, defect));
    of_pair.any(|defect| !options.repairs(defect))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A map on two surfaces, one of which has a further map; and two that have nothing to do with them.
    #[test]
    fn what_shares_a_map_or_a_surface_with_something_left_is_left() {
        let link = |image: usize, primitive: usize, is_left: bool| Link {
            image,
            primitive: (0, primitive),
            pair: Some(&PAIRS[0]),
            is_left,
        };
        let links = || vec![link(0, 0, true), link(0, 1, false), link(1, 1, false), link(2, 2, false)];
        let left: Vec<(usize, Key)> =
            left_links(links()).into_iter().map(|link| (link.image, link.primitive)).collect();
        assert_eq!(left, [(0, (0, 0)), (0, (0, 1)), (1, (0, 1))]);
        let none = links().into_iter().map(|link| Link { is_left: false, ..link }).collect();
        assert!(left_links(none).is_empty());
    }
}
