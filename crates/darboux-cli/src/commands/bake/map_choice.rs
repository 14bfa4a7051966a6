//! The values of `--map`: a map, or all maps of a material.

use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use darboux::{Choice, UnknownName};
use darboux_bake::MapKind;

use crate::options::choice::possible_values;

/// The name of all maps of a material.
const MATERIAL: &str = "material";

/// The maps of a material without opacity, which most materials do not have.
const OF_MATERIAL: [MapKind; 6] = [
    MapKind::Normal,
    MapKind::Occlusion,
    MapKind::BaseColor,
    MapKind::Roughness,
    MapKind::Metalness,
    MapKind::Emission,
];

/// A value of `--map`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MapChoice {
    Map(MapKind),
    Material,
}

impl MapChoice {
    /// Its maps.
    pub fn maps(&self) -> &[MapKind] {
        match self {
            Self::Map(map) => std::slice::from_ref(map),
            Self::Material => &OF_MATERIAL,
        }
    }

    fn from_name(name: &str) -> Result<Self, UnknownName> {
        if name == MATERIAL { Ok(Self::Material) } else { MapKind::from_name(name).map(Self::Map) }
    }
}

/// Accepts the names of maps, and of those of a material; the help shows their descriptions.
pub fn map_choice() -> impl TypedValueParser<Value = MapChoice> {
    let material = PossibleValue::new(MATERIAL)
        .help("The maps of a glTF material: normal, ao, base-color, roughness, metalness and emission");
    let names = possible_values::<MapKind>().chain([material]);
    PossibleValuesParser::new(names).try_map(|name| MapChoice::from_name(&name))
}
