//! How the tangents of a file were made.

use std::collections::HashMap;

use darboux::{
    Choice, Convention, Mesh, Method, Mode, RecipeMatch, RecipeRounding, RecipeWriting, recognise_recipe,
};
use darboux_io::Error;
use darboux_io::gltf::{Document, PrimitiveInfo};
use darboux_io::words::Count;
use serde::Serialize;

use crate::text::counted;

/// The way of making tangents that comes nearest to a primitive's tangents. json.txt documents its fields.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct MadeBy {
    pub method: &'static str,
    /// The mode of MikkTSpace.
    pub mode: Option<&'static str>,
    pub corners: usize,
    pub identical: usize,
    pub close: usize,
    /// What else is known, as clauses: that tangents were made before quads were cut, for example.
    pub details: Vec<&'static str>,
}

/// The share of close corners from which on tangents are attributed to a method, as in `darboux check`.
const IS_KNOWN: f64 = 0.9;

/// The recipe of each primitive with tangents, in the order of `infos`. None: it has no tangents, or lacks
/// what they are computed from.
///
/// Errors: invalid data.
pub fn recipes(document: &Document, infos: &[PrimitiveInfo]) -> Result<Vec<Option<MadeBy>>, Error> {
    let mut found = vec![None; infos.len()];
    if infos.iter().all(|info| !info.has_tangents) {
        return Ok(found);
    }
    let places = infos.iter().enumerate().map(|(place, info)| ((info.name.mesh, info.name.primitive), place));
    let places: HashMap<(usize, usize), usize> = places.collect();
    for corners in document.corners()? {
        let Some(&place) = places.get(&(corners.name().mesh, corners.name().primitive)) else { continue };
        let info = &infos[place];
        if !info.has_tangents || corners.is_empty() {
            continue;
        }
        let uv_set = format!("TEXCOORD_{}", info.uv_set);
        let (Some(positions), Some(normals), Some(uvs), Some(tangents)) = (
            corners.used_vectors::<3>("POSITION")?,
            corners.used_vectors::<3>("NORMAL")?,
            corners.used_vectors::<2>(&uv_set)?,
            corners.vectors::<4>("TANGENT")?,
        ) else {
            continue;
        };
        let to_generated = Convention::GLTF.to(Convention::GLTF.generated());
        let tangents: Vec<[f32; 4]> = tangents.iter().map(|&tangent| to_generated.tangent(tangent)).collect();
        let mesh = Mesh::triangles(&*positions, &*normals, &*uvs, corners.used_indices());
        found[place] = mesh.ok().and_then(|mesh| MadeBy::nearest(&mesh, &tangents));
    }
    Ok(found)
}

impl MadeBy {
    /// The nearest way, also for tangents whose signs w are all flipped.
    fn nearest(mesh: &Mesh<'_>, tangents: &[[f32; 4]]) -> Option<Self> {
        let of = |tangents: &[[f32; 4]]| recognise_recipe(mesh, tangents).ok()?.first().copied();
        let as_they_are = of(tangents)?;
        if Self::is_known(&as_they_are) {
            return Some(Self::new(&as_they_are, false));
        }
        let flipped: Vec<[f32; 4]> = tangents.iter().map(|&[x, y, z, w]| [x, y, z, -w]).collect();
        let with_flipped = of(&flipped).filter(Self::is_known);
        Some(with_flipped.map_or_else(|| Self::new(&as_they_are, false), |found| Self::new(&found, true)))
    }

    fn is_known(found: &RecipeMatch) -> bool {
        found.close as f64 >= IS_KNOWN * found.corners as f64
    }

    fn new(found: &RecipeMatch, are_signs_flipped: bool) -> Self {
        let recipe = &found.recipe;
        let mode = match recipe.method {
            Method::MikkTSpace(options) => Some(options.mode),
            _ => None,
        };
        let details = [
            (are_signs_flipped, "all signs w flipped"),
            (recipe.flips_v, "computed with v turned"),
            (recipe.from_quads, "computed before quads were cut into triangles"),
            (recipe.writing == RecipeWriting::LastCorner, "each vertex has the tangent of its last corner"),
            (recipe.writing == RecipeWriting::FirstCorner, "each vertex has the tangent of its first corner"),
            (recipe.rounding == RecipeRounding::Bits8, "rounded to 8 bits"),
            (recipe.rounding == RecipeRounding::Bits16, "rounded to 16 bits"),
        ];
        Self {
            method: recipe.method.name(),
            mode: mode.map(Mode::name),
            corners: found.corners,
            identical: found.identical,
            close: found.close,
            details: details.into_iter().filter(|(is, _)| *is).map(|(_, detail)| detail).collect(),
        }
    }

    /// One line for the table.
    pub fn describe(&self) -> String {
        let Self { method, corners, identical, close, details, .. } = self;
        let mode = self.mode.map(|mode| format!(", mode {mode}")).unwrap_or_default();
        let details: String = details.iter().map(|detail| format!(", {detail}")).collect();
        let (of, near) = (counted(*corners, "corner", "corners"), Count(close));
        if identical == corners {
            format!("tangents made by {method}{mode}{details}: all bits are equal")
        } else if *close as f64 >= IS_KNOWN * *corners as f64 {
            format!("tangents made by {method}{mode}{details}: {near} of {of} within 0.1 degrees")
        } else {
            format!(
                "tangents made by no known method; nearest is {method}: {near} of {of} within 0.1 degrees"
            )
        }
    }
}
