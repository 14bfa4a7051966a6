//! [`Pair`]: mistakes in a map and in tangents that cancel each other.

use darboux::Recipe;

use crate::code::Code;
use crate::place::Place;

/// What is wrong with a map, and what is wrong with tangents so that it cancels.
#[derive(Debug, PartialEq)]
pub struct Pair {
    pub on_map: &'static [Code],
    pub on_surface: &'static [Code],
}

impl Pair {
    /// Whether defects of a code are a part of the pair.
    pub fn contains(&self, code: Code) -> bool {
        self.on_map.contains(&code) || self.on_surface.contains(&code)
    }
}

/// Negated tangents with their old sign w negate the bitangents, too.
pub static PAIRS: [Pair; 3] = [
    Pair { on_map: &[Code::MapGreenFlipped], on_surface: &[Code::TangentSignFlipped] },
    Pair { on_map: &[Code::MapRedFlipped], on_surface: &[Code::TangentNegated, Code::TangentSignFlipped] },
    Pair { on_map: &[Code::MapRedFlipped, Code::MapGreenFlipped], on_surface: &[Code::TangentNegated] },
];

/// The mistake that cancels a defect.
#[derive(Clone, Debug, PartialEq)]
pub enum Cancelled {
    /// The mistake of the normal map in an image; none for a map without a document.
    ByMap {
        pair: &'static Pair,
        image: Option<usize>,
        /// Whether it cancels on all surfaces that use the map.
        is_whole: bool,
    },
    /// The mistake of a surface, or of several that use the map: the first one.
    BySurface {
        pair: &'static Pair,
        first: Option<Place>,
        are_several: bool,
        /// Whether nearly all of the area of a surface is meant, and not all.
        is_of_most: bool,
        /// The known method, other than MikkTSpace, that computed the tangents of a surface.
        recipe: Option<Recipe>,
    },
}
