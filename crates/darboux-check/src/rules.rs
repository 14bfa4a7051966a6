//! The rules: each turns the facts of one surface, map or material into defects. No rule knows another: what
//! several need is measured before.

mod maps;
mod normals;
mod positions;
mod recipes;
mod rule;
mod tangents;
mod transforms;
mod uvs;

pub use maps::unreadable;
use rule::{MapRule, MaterialRule, SurfaceRule};

/// All rules about surfaces: causes before what follows from them.
pub const SURFACE_RULES: &[&[SurfaceRule]] =
    &[positions::RULES, normals::RULES, uvs::RULES, tangents::RULES, recipes::RULES, uvs::REMARKS];

/// All rules about normal maps.
pub const MAP_RULES: &[MapRule] = maps::RULES;

/// All rules about the use of normal maps.
pub const MATERIAL_RULES: &[MaterialRule] = transforms::RULES;
