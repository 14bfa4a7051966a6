//! An OBJ, its objects in the order of the scene, and its material library.
//!
//! Numbers are written so that they read back as the same bits.

use std::collections::{BTreeMap, HashMap, HashSet};
use std::fmt::Write;
use std::sync::Arc;

use super::surfaces::Surface;
use crate::Error;
use crate::gltf::{Alpha, Document, Material, TextureUse, Wrap};
use crate::image::linear_to_srgb;

/// The materials of an OBJ.
pub struct Materials {
    /// The name of each material.
    pub names: Vec<String>,
    /// The text of the library.
    pub library: String,
}

/// The text. `library`: the file name of the material library.
pub fn text(surfaces: &[Surface], materials: &Materials, library: &str) -> String {
    let mut out = format!("# Created by Darboux {}\n", env!("CARGO_PKG_VERSION"));
    if !materials.names.is_empty() {
        _ = writeln!(out, "mtllib {library}");
    }
    let mut lists = Lists::default();
    let mut names = ObjectNames::of(surfaces);
    for objects in surfaces.chunk_by(is_one_object) {
        _ = writeln!(out, "o {}", names.name(&objects[0].name));
        objects.iter().for_each(|surface| lists.write(surface, materials, &mut out));
    }
    out
}

/// Whether a surface and the next one belong to one object.
fn is_one_object(a: &Surface, b: &Surface) -> bool {
    Arc::ptr_eq(&a.name, &b.name) || *a.name == *b.name
}

/// The names of objects, each as it is written.
struct ObjectNames<'a> {
    longest: usize,
    written: HashMap<&'a str, String>,
}

impl<'a> ObjectNames<'a> {
    fn of(surfaces: &'a [Surface]) -> Self {
        let names = surfaces.chunk_by(is_one_object).map(|objects| &*objects[0].name);
        Self { longest: longest_name(names), written: HashMap::new() }
    }

    fn name(&mut self, name: &'a str) -> &str {
        let number = self.written.len();
        self.written.entry(name).or_insert_with(|| cut(one_line(name, "Surface"), self.longest, number))
    }
}

/// The numbered positions, UVs and normals of the file. Equal ones are written once, so that surfaces stay
/// connected at seams.
#[derive(Default)]
struct Lists {
    positions: Numbered<6>,
    uvs: Numbered<2>,
    normals: Numbered<3>,
}

#[derive(Default)]
struct Numbered<const N: usize> {
    numbers: HashMap<[u32; N], usize>,
}

impl<const N: usize> Numbered<N> {
    /// The number of a value, which is written if it is new.
    fn of(&mut self, statement: &str, value: [f32; N], written: &[f32], out: &mut String) -> usize {
        let next = self.numbers.len() + 1;
        *self.numbers.entry(value.map(f32::to_bits)).or_insert_with(|| {
            out.push_str(statement);
            written.iter().for_each(|number| _ = write!(out, " {number}"));
            out.push('\n');
            next
        })
    }
}

impl Lists {
    fn write(&mut self, surface: &Surface, materials: &Materials, out: &mut String) {
        let corners: Vec<String> =
            (0..surface.positions.len()).map(|vertex| self.corner(surface, vertex, out)).collect();
        if let Some(name) = surface.material.and_then(|material| materials.names.get(material)) {
            _ = writeln!(out, "usemtl {name}");
        }
        let mut rest = surface.corners.as_slice();
        for &size in &surface.sizes {
            let (face, after) = rest.split_at(size as usize);
            out.push('f');
            face.iter().for_each(|&vertex| _ = write!(out, " {}", corners[vertex as usize]));
            out.push('\n');
            rest = after;
        }
    }

    /// A corner such as `3/1/2`, after its new values.
    fn corner(&mut self, surface: &Surface, vertex: usize, out: &mut String) -> String {
        let [x, y, z] = surface.positions[vertex];
        let color = surface.colors.as_ref().map(|colors| {
            let [r, g, b, _] = colors[vertex];
            [r, g, b].map(|channel| linear_to_srgb(f64::from(channel)) as f32)
        });
        let [r, g, b] = color.unwrap_or([0.0; 3]);
        let value = [x, y, z, r, g, b];
        let written = if color.is_some() { &value[..] } else { &value[..3] };
        let mut corner = self.positions.of("v", value, written, out).to_string();
        let uv = surface.uvs.as_ref().map(|uvs| [uvs[vertex][0], 1.0 - uvs[vertex][1]]);
        let uv = uv.map(|uv| self.uvs.of("vt", uv, &uv, out).to_string());
        let normal = surface.normals.as_ref().map(|normals| normals[vertex]);
        let normal = normal.map(|normal| self.normals.of("vn", normal, &normal, out));
        match (uv, normal) {
            (Some(uv), Some(normal)) => _ = write!(corner, "/{uv}/{normal}"),
            (Some(uv), None) => _ = write!(corner, "/{uv}"),
            (None, Some(normal)) => _ = write!(corner, "//{normal}"),
            (None, None) => {}
        }
        corner
    }
}

/// The most characters of a name.
const LONGEST_NAME: usize = 1000;

/// The most characters of a name where many are written. A mesh or a material that is at many places has its
/// name written as often.
const LONGEST_OF_MANY: usize = 60;

/// Names of so many bytes are written as they are, and so many more for each of them.
const NAME_BYTES: usize = 1 << 20;

/// The most characters of names that are written in turn.
fn longest_name<'a>(names: impl Iterator<Item = &'a str>) -> usize {
    let length = |name: &str| name.char_indices().nth(LONGEST_NAME).map_or(name.len(), |(end, _)| end);
    let (count, bytes) = names.fold((0, 0), |(count, bytes), name| (count + 1, bytes + length(name)));
    if bytes <= NAME_BYTES + LONGEST_OF_MANY * count { LONGEST_NAME } else { LONGEST_OF_MANY }
}

/// A name with at most so many characters. One that is cut ends in its number, which tells it from others.
fn cut(name: String, longest: usize, number: usize) -> String {
    match name.char_indices().nth(longest) {
        Some((end, _)) if longest < LONGEST_NAME => format!("{}_{number}", &name[..end]),
        _ => name,
    }
}

/// A name that a statement can end with: without line breaks, other control characters, and the mark of a
/// continued line; `otherwise` for none.
fn one_line(name: &str, otherwise: &str) -> String {
    let name: String =
        name.chars().take(LONGEST_NAME).map(|c| if c.is_control() { ' ' } else { c }).collect();
    let name = name.split_whitespace().collect::<Vec<_>>().join(" ");
    let end = name.trim_end_matches('\\').len();
    let name = name[..end].to_owned() + &"_".repeat(name.len() - end);
    if name.is_empty() { otherwise.to_owned() } else { name }
}

/// The textures that are written: MTL has a statement for them, and they lie on the UVs that are written.
pub(super) fn textures(material: &Material) -> impl Iterator<Item = (&'static str, &TextureUse)> {
    all_textures(material).filter(|(_, texture)| texture.uv_set == material.tangent_uv_set)
}

/// The textures that MTL has a statement for.
pub(super) fn all_textures(material: &Material) -> impl Iterator<Item = (&'static str, &TextureUse)> {
    [
        ("map_Kd", &material.base_texture),
        ("map_Ke", &material.emission_texture),
        ("map_Pr", &material.metallic_roughness_texture),
        ("map_Pm", &material.metallic_roughness_texture),
        ("norm", &material.normal_texture),
    ]
    .into_iter()
    .filter_map(|(statement, texture)| Some((statement, texture.as_ref()?)))
}

/// The images that materials refer to, ascending.
pub fn images(document: &Document) -> Result<Vec<usize>, Error> {
    let materials = document.materials()?;
    let used = materials.iter().flat_map(textures).filter_map(|(_, texture)| texture.image);
    let mut images: Vec<usize> = used.collect();
    images.sort_unstable();
    images.dedup();
    Ok(images)
}

/// The materials of a document. `paths`: the path of each image in the library; none for an image without a
/// file. `surfaces`: those that name the materials.
pub fn materials(
    document: &Document,
    surfaces: &[Surface],
    paths: &[Option<String>],
) -> Result<Materials, Error> {
    let materials = document.materials()?;
    let name = |index: usize| document.json()["materials"][index]["name"].as_str().unwrap_or_default();
    let longest = longest_name(surfaces.iter().filter_map(|surface| surface.material).map(name));
    let names = unique_names(materials.len(), name, longest);
    let mut library = format!("# Created by Darboux {}\n", env!("CARGO_PKG_VERSION"));
    for (name, material) in names.iter().zip(&materials) {
        write_material(name, material, paths, &mut library);
    }
    Ok(Materials { names, library })
}

fn write_material(name: &str, material: &Material, paths: &[Option<String>], out: &mut String) {
    let srgb = |color: [f32; 3]| color.map(|channel| linear_to_srgb(f64::from(channel)) as f32);
    let [r, g, b, alpha] = material.base_color;
    let alpha = if material.alpha == Alpha::Opaque { 1.0 } else { alpha };
    _ = writeln!(out, "\nnewmtl {name}");
    let colors = BTreeMap::from([("Kd", srgb([r, g, b])), ("Ke", srgb(material.emission))]);
    for (statement, [r, g, b]) in colors {
        _ = writeln!(out, "{statement} {r} {g} {b}");
    }
    _ = writeln!(out, "d {alpha}\nPr {}\nPm {}", material.roughness, material.metallic);
    for (statement, texture) in textures(material) {
        let Some(path) = texture.image.and_then(|image| paths.get(image)?.as_ref()) else { continue };
        _ = write!(out, "{statement} ");
        if statement == "norm" && material.normal_scale != 1.0 {
            _ = write!(out, "-bm {} ", material.normal_scale);
        }
        write_placement(texture, out);
        _ = writeln!(out, "{path}");
    }
}

/// The options that place a texture. `v` points up in MTL: v' = scale * v + offset for 1 - v of glTF.
fn write_placement(texture: &TextureUse, out: &mut String) {
    if let Some(([x, y], [scale_u, scale_v])) = texture.offset_and_scale() {
        let offset = [x, (1.0 - f64::from(scale_v) - f64::from(y)) as f32];
        if offset != [0.0; 2] {
            _ = write!(out, "-o {} {} 0 ", offset[0], offset[1]);
        }
        if [scale_u, scale_v] != [1.0; 2] {
            _ = write!(out, "-s {scale_u} {scale_v} 1 ");
        }
    }
    if is_clamped(texture) == Some(true) {
        out.push_str("-clamp on ");
    }
}

/// Whether a texture is clamped, as `-clamp` says it; none where it is mirrored, or clamped along one axis,
/// which MTL cannot say.
pub(super) fn is_clamped(texture: &TextureUse) -> Option<bool> {
    let [along_u, along_v] = texture.wrap;
    (along_u == along_v && along_u != Wrap::Mirror).then_some(along_u == Wrap::Clamp)
}

/// A name for each material, without white space, each once: `usemtl` names one.
fn unique_names<'a>(count: usize, name: impl Fn(usize) -> &'a str, longest: usize) -> Vec<String> {
    let mut taken = HashSet::new();
    // The next number of each name, so that many equal names take no more time each than the first.
    let mut next_number: HashMap<String, u32> = HashMap::new();
    let name_of = |index: usize| {
        let name = one_line(name(index), &format!("Material_{index}")).replace(' ', "_");
        let name = cut(name, longest, index);
        let mut unique = name.clone();
        let number = next_number.entry(name.clone()).or_insert(1);
        while !taken.insert(unique.clone()) {
            unique = format!("{name}_{number}");
            *number += 1;
        }
        unique
    };
    (0..count).map(name_of).collect()
}
