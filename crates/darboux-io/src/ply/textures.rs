//! The textures of comments such as `TextureFile wood.png`, which MeshLab writes: a material each.

use std::borrow::Cow;

use super::header::Header;
use crate::error::system_reason;
use crate::source::{ModelFiles, SourceImage, SourceMaterial, SourceScene, SourceTexture};

/// The most textures. Files of MeshLab have a few; each makes a material.
const MOST: usize = 10_000;

/// Adds a material for each texture that the comments name, with its image where the file is found. Returns
/// how many.
pub fn add(header: &Header, files: &ModelFiles, scene: &mut SourceScene) -> usize {
    let names = header.comments.iter().filter_map(|comment| {
        let rest = comment.strip_prefix("comment")?.trim_start();
        let (word, name) = rest.split_once(char::is_whitespace)?;
        word.eq_ignore_ascii_case("TextureFile").then_some(name.trim())
    });
    for name in names.take(MOST) {
        let name = &*with_stem(name, files.stem());
        let image = image(name, files, scene);
        let texture = image.map(|image| SourceTexture { image, ..SourceTexture::default() });
        scene.materials.push(SourceMaterial {
            name: name.rsplit(['/', '\\']).next().unwrap_or(name).to_owned(),
            base_color_texture: texture,
            metallic: Some(0.0),
            ..SourceMaterial::default()
        });
    }
    scene.materials.len()
}

/// The name of a texture in which MeshLab's `<this>`, in letters of any case, is replaced with the name of
/// the PLY without folder and ending.
fn with_stem<'a>(name: &'a str, stem: &str) -> Cow<'a, str> {
    const THIS: &str = "<this>";
    match name.to_ascii_lowercase().find(THIS) {
        Some(start) => format!("{}{stem}{}", &name[..start], &name[start + THIS.len()..]).into(),
        None => name.into(),
    }
}

/// The image of a texture; none where it cannot be read, which a warning says.
fn image(name: &str, files: &ModelFiles, scene: &mut SourceScene) -> Option<usize> {
    files.begin_reference();
    let Some(file) = files.find("", name) else {
        scene.warnings.push(format!("{}; the texture is left out", files.problem(name)));
        return None;
    };
    scene.warnings.extend(ModelFiles::by_name_warning(name, &file));
    match files.read(&file) {
        Ok(bytes) => {
            scene.images.push(SourceImage { name: file.name, bytes });
            Some(scene.images.len() - 1)
        }
        Err(error) => {
            let reason = system_reason(&error);
            scene.warnings.push(format!("{}: cannot be read: {reason}; the texture is left out", file.name));
            None
        }
    }
}
