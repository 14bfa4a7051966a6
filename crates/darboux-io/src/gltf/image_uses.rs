//! Finds the materials' textures that use an image.

use std::collections::HashMap;

use crate::json::{self, Value};

use super::Document;
use super::materials::Texture;

/// The members of materials that are normal maps.
const NORMAL_MAPS: [&str; 2] = ["normalTexture", "clearcoatNormalTexture"];

impl Document {
    /// The images whose texels cannot be changed as a normal map, each with the reason, as a clause whose
    /// subject is the image.
    ///
    /// They cannot where a material also uses the image as another texture, and where its texture refers to
    /// the same picture in several formats.
    pub fn normal_map_obstacles(&self) -> HashMap<usize, &'static str> {
        let textures: Vec<Texture> = json::read(&self.json["textures"], "textures").unwrap_or_default();
        let in_several_formats = textures.iter().filter(|texture| texture.formats() > 1);
        let images = in_several_formats.filter_map(Texture::image);
        let mut obstacles: HashMap<usize, &str> =
            images.map(|image| (image, "is one of several formats of its texture")).collect();
        for_each_other_use(&self.json["materials"], "", &mut |index| {
            let texture = usize::try_from(index).ok().and_then(|index| textures.get(index));
            let image = texture.and_then(Texture::image);
            obstacles.extend(image.map(|image| (image, "is used as another texture, too")));
        });
        obstacles
    }
}

/// Visits the textures of a part of a material, which is the member `key`, that are no normal maps.
fn for_each_other_use(value: &Value, key: &str, visit: &mut dyn FnMut(u64)) {
    match value {
        Value::Object(members) => {
            let index = members.get("index").and_then(Value::as_u64);
            index.filter(|_| !NORMAL_MAPS.contains(&key)).into_iter().for_each(&mut *visit);
            members.iter().for_each(|(key, value)| for_each_other_use(value, key, visit));
        }
        Value::Array(elements) => elements.iter().for_each(|value| for_each_other_use(value, key, visit)),
        _ => {}
    }
}
