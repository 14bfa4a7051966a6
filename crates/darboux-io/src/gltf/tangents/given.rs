//! Tangents that the caller has, one per corner: written as computed ones are, with split vertices where
//! corners need different ones.

use std::collections::HashMap;

use darboux::{Convention, CornerTangents, Tangents};

use crate::gltf::PrimitiveName;

/// The tangents of the corners of some primitives.
#[derive(Clone, Copy, Debug)]
pub struct GivenTangents<'a> {
    /// Primitives with the same triangles.
    pub primitives: &'a [PrimitiveName],
    /// One tangent per corner of the complete triangles, where strips and fans are written as lists: unit
    /// xyz and the sign w, in glTF's convention.
    pub tangents: &'a [[f32; 4]],
}

/// Which of the given tangents each primitive gets.
#[derive(Clone, Debug, Default)]
pub struct GivenPlaces<'a> {
    given: &'a [GivenTangents<'a>],
    place_of: HashMap<(usize, usize), usize>,
}

impl<'a> GivenPlaces<'a> {
    pub fn new(given: &'a [GivenTangents<'a>]) -> Self {
        let places = given.iter().enumerate().flat_map(|(place, given)| {
            given.primitives.iter().map(move |name| ((name.mesh, name.primitive), place))
        });
        Self { given, place_of: places.collect() }
    }

    /// The place in `given` of a primitive's tangents.
    pub fn of(&self, name: &PrimitiveName) -> Option<usize> {
        self.place_of.get(&(name.mesh, name.primitive)).copied()
    }

    /// The tangents at a place, as generated ones are. A failure is one sentence.
    pub fn tangents(&self, place: Option<usize>, corner_count: usize) -> Result<Tangents, String> {
        let given = place.and_then(|place| self.given.get(place)).map_or(&[][..], |given| given.tangents);
        if given.len() != corner_count {
            return Err(format!("has {corner_count} corners, but {} tangents were given", given.len()));
        }
        let corners = CornerTangents::from_per_corner(given.to_vec());
        let corners = corners.converted(Convention::GLTF, Convention::GLTF.generated());
        Ok(Tangents { corners, ..Tangents::default() })
    }
}
