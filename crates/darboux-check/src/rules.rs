//! The rules: each looks at one surface, map or material and returns what it finds. No rule knows another.

mod maps;
mod normals;
mod positions;
mod tangents;
mod transforms;
mod uvs;

pub use normals::UNIT as UNIT_NORMAL;

use crate::rule::{MapRule, SurfaceRule, TextureRule};

/// All rules about surfaces.
pub const SURFACE_RULES: &[&[SurfaceRule]] = &[tangents::RULES, positions::RULES, normals::RULES, uvs::RULES];

/// All rules about normal maps.
pub const MAP_RULES: &[MapRule] = maps::RULES;

/// All rules about the use of normal maps.
pub const TEXTURE_RULES: &[TextureRule] = transforms::RULES;
