//! Textures of primitives without their UV sets, which glTF does not permit: such primitives get a copy of
//! the material without these textures.

use std::collections::{BTreeSet, HashMap};

use serde_json::Value;

use crate::error::shortened;
use crate::source::scene::{SourceMaterial, SourceScene, SourceTexture};
use crate::words::counted;

/// The longest name that each copy repeats, in bytes.
const LONGEST_NAME: usize = 1000;

/// Replaces the materials of primitives that lack UV sets of their textures by copies, which it adds to the
/// scene. Returns a sentence about them; none for none.
pub fn replace(scene: &mut SourceScene, meshes: &mut [Value]) -> Option<String> {
    let mut copies: HashMap<(usize, usize), usize> = HashMap::new();
    let (mut first, mut primitives) = (String::new(), 0);
    let lists = meshes.iter_mut().filter_map(|mesh| mesh["primitives"].as_array_mut());
    for primitive in lists.flatten() {
        let Some(index) = primitive["material"].as_u64().map(|index| index as usize) else { continue };
        let Some(material) = scene.materials.get(index) else { continue };
        let sets =
            (0..).take_while(|set| !primitive["attributes"][format!("TEXCOORD_{set}")].is_null()).count();
        if !needs_more(material, sets) {
            continue;
        }
        if primitives == 0 {
            first = shortened(&material.name);
        }
        primitives += 1;
        let copy = *copies.entry((index, sets)).or_insert_with(|| {
            let copy = with_uv_sets(&scene.materials[index], sets);
            scene.materials.push(copy);
            scene.materials.len() - 1
        });
        primitive["material"] = copy.into();
    }
    let materials = copies.keys().map(|(material, _)| material).collect::<BTreeSet<_>>().len();
    let others = materials.checked_sub(1)?;
    let others = if others == 0 { String::new() } else { format!(" and {others} more") };
    let lack = if primitives == 1 { "lacks" } else { "lack" };
    let primitives = counted(primitives, "primitive", "primitives");
    Some(format!(
        "{primitives} of the material {first}{others} {lack} UVs of its textures; a copy of the material \
         without these textures is used there"
    ))
}

fn textures(material: &SourceMaterial) -> impl Iterator<Item = &SourceTexture> {
    let colors = [
        &material.base_color_texture,
        &material.metallic_roughness_texture,
        &material.occlusion_texture,
        &material.emissive_texture,
    ];
    let normals = material.normal_map.iter().map(|map| &map.texture);
    colors.into_iter().flatten().chain(normals)
}

fn needs_more(material: &SourceMaterial, sets: usize) -> bool {
    textures(material).any(|texture| texture.uv_set >= sets)
}

/// A copy of a material with the textures of the first UV sets.
fn with_uv_sets(material: &SourceMaterial, sets: usize) -> SourceMaterial {
    let mut copy = material.clone();
    let left = match sets {
        0 => "no textures".to_owned(),
        1 => "UV set 0 only".to_owned(),
        sets => format!("UV sets 0 to {} only", sets - 1),
    };
    let is_long = material.name.len() > LONGEST_NAME;
    copy.name =
        format!("{} ({left})", if is_long { shortened(&material.name) } else { material.name.clone() });
    let lacks = |texture: &mut SourceTexture| texture.uv_set >= sets;
    copy.base_color_texture.take_if(lacks);
    copy.metallic_roughness_texture.take_if(lacks);
    copy.occlusion_texture.take_if(lacks);
    copy.emissive_texture.take_if(lacks);
    copy.normal_map.take_if(|map| lacks(&mut map.texture));
    copy.missing_normal_map.take_if(|map| map.uv_set >= sets);
    copy
}
