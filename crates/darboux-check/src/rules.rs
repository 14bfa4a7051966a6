//! The rules: each looks at one surface, map or material and returns what it finds. No rule knows another.

mod maps;
mod normals;
mod positions;
mod recipes;
mod tangents;
mod transforms;
mod uvs;

pub use maps::{BY_FACES, directions_by_mesh};
pub use normals::UNIT as UNIT_NORMAL;
pub use tangents::{SIGN, UNIT as UNIT_TANGENT, has_length, is_finite, leaning};

use crate::rule::{MapRule, MaterialRule, SurfaceRule};

/// All rules about surfaces: causes before what follows from them.
pub const SURFACE_RULES: &[&[SurfaceRule]] =
    &[positions::RULES, normals::RULES, uvs::RULES, tangents::RULES, recipes::RULES, uvs::REMARKS];

/// All rules about normal maps.
pub const MAP_RULES: &[MapRule] = maps::RULES;

/// All rules about the use of normal maps.
pub const MATERIAL_RULES: &[MaterialRule] = transforms::RULES;
