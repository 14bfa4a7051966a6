//! Finds the materials' textures that use an image.

use crate::json::{self, Value};

use super::Document;
use super::materials::Texture;

/// The members of materials that are normal maps.
const NORMAL_MAPS: [&str; 2] = ["normalTexture", "clearcoatNormalTexture"];

impl Document {
    /// Why the texels of an image cannot be changed as those of a normal map, as a clause whose subject is
    /// the image; none if they can.
    ///
    /// They cannot where a material also uses the image as another texture, and where its texture refers to
    /// the same picture in several formats.
    pub fn normal_map_obstacle(&self, image: usize) -> Option<&'static str> {
        let textures: Vec<Texture> = json::read(&self.json["textures"], "textures").unwrap_or_default();
        let is_texture = |index: u64| {
            let texture = usize::try_from(index).ok().and_then(|index| textures.get(index));
            texture.is_some_and(|texture| texture.image() == Some(image))
        };
        if has_other_use(&self.json["materials"], "", &is_texture) {
            return Some("is used as another texture, too");
        }
        let is_in_several_formats =
            |texture: &Texture| texture.image() == Some(image) && texture.formats() > 1;
        let is_alternative = textures.iter().any(is_in_several_formats);
        is_alternative.then_some("is one of several formats of its texture")
    }
}

/// Whether a part of a material, which is the member `key`, has a texture that is no normal map and fulfils a
/// condition.
fn has_other_use(value: &Value, key: &str, is_texture: &dyn Fn(u64) -> bool) -> bool {
    match value {
        Value::Object(members) => {
            let index = members.get("index").and_then(Value::as_u64);
            let is_other = !NORMAL_MAPS.contains(&key) && index.is_some_and(is_texture);
            is_other || members.iter().any(|(key, value)| has_other_use(value, key, is_texture))
        }
        Value::Array(elements) => elements.iter().any(|value| has_other_use(value, key, is_texture)),
        _ => false,
    }
}
