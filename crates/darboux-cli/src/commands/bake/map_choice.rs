//! The values of `--map`: a map, or all maps of a material.

use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use darboux::{Choice, UnknownName};
use darboux_bake::MapKind;
use darboux_io::gltf::Document;
use darboux_io::gltf::schema::Primitive;

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

/// Those that show something of high models without materials.
const WITHOUT_MATERIALS: [MapKind; 3] = [MapKind::Normal, MapKind::Occlusion, MapKind::BaseColor];

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

/// The choices for these high models, and a warning where they are fewer: a surface without a material is
/// white metal in glTF, which nobody wants in a texture. Maps that were named are kept. `writes_model`:
/// whether they go into the low model.
pub fn choices_for(
    choices: &[MapChoice],
    highs: &[Document],
    writes_model: bool,
) -> (Vec<MapChoice>, Option<String>) {
    if !choices.contains(&MapChoice::Material) || highs.iter().any(has_materials) {
        return (choices.to_vec(), None);
    }
    let has_colors = highs.iter().any(has_vertex_colors);
    let shows = &WITHOUT_MATERIALS[..if has_colors { 3 } else { 2 }];
    let of_choice = |choice: &MapChoice| match choice {
        MapChoice::Material => shows.iter().copied().map(MapChoice::Map).collect(),
        &map => vec![map],
    };
    let left_out = OF_MATERIAL.iter().filter(|map| !shows.contains(map)).map(|map| map.name());
    let left_out = left_out.collect::<Vec<_>>().join(", ");
    let kept = if writes_model { "; the low model keeps its own" } else { "" };
    let warning = format!("the high models have no materials, so {left_out} are not baked{kept}");
    (choices.iter().flat_map(of_choice).collect(), Some(warning))
}

/// Whether a primitive of a model has a material.
fn has_materials(document: &Document) -> bool {
    has_primitive(document, |primitive| primitive.material.is_some())
}

/// Whether a primitive of a model has vertex colours.
pub fn has_vertex_colors(document: &Document) -> bool {
    has_primitive(document, |primitive| primitive.attributes.contains_key("COLOR_0"))
}

fn has_primitive(document: &Document, is: impl Fn(&Primitive) -> bool) -> bool {
    document.meshes().iter().flat_map(|mesh| &mesh.primitives).any(is)
}

/// Accepts the names of maps, and of those of a material; the help shows their descriptions.
pub fn map_choice() -> impl TypedValueParser<Value = MapChoice> {
    let material = PossibleValue::new(MATERIAL)
        .help("The maps of a glTF material: normal, ao, base-color, roughness, metalness and emission");
    let names = possible_values::<MapKind>().chain([material]);
    PossibleValuesParser::new(names).try_map(|name| MapChoice::from_name(&name))
}
