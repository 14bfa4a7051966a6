//! Parses material libraries (MTL), with the metallic-roughness statements that Blender and other programs
//! write.

use std::collections::BTreeSet;

use super::statements::{statements, words};
use super::texture_map::MtlMap;
use crate::code_page::decoded;
use crate::error::shortened;
use crate::source::without_byte_order_mark;

/// A material of a library.
#[derive(Clone, Debug, Default)]
pub struct MtlMaterial {
    pub name: String,
    /// The bytes of the name, by which faces refer to it.
    pub name_bytes: Vec<u8>,
    /// `Kd` and `Ke`, in the library's [colour space](has_linear_colors).
    pub diffuse: Option<[f32; 3]>,
    pub emissive: Option<[f32; 3]>,
    /// `Ns`, from 0 to 1000.
    pub shininess: Option<f32>,
    /// `Pr` and `Pm`.
    pub roughness: Option<f32>,
    pub metallic: Option<f32>,
    /// `d`, or 1 - `Tr`.
    pub opacity: Option<f32>,
    pub diffuse_map: Option<MtlMap>,
    pub emissive_map: Option<MtlMap>,
    pub roughness_map: Option<MtlMap>,
    pub metallic_map: Option<MtlMap>,
    /// `norm`.
    pub normal_map: Option<MtlMap>,
    /// The statements for heights, where many programs write normal maps.
    pub bump_map: Option<MtlMap>,
    /// What has no place in glTF: a noun phrase each.
    pub lost: BTreeSet<String>,
}

/// Whether `Kd` and `Ke` are linear: Blender writes them so. Other programs write what a screen shows, sRGB.
pub fn has_linear_colors(text: &[u8]) -> bool {
    without_byte_order_mark(text).starts_with(b"# Blender ")
}

/// The materials of a library. Statements before the first `newmtl`, and unknown ones, are ignored.
pub fn parse(text: &[u8]) -> Vec<MtlMaterial> {
    let mut materials: Vec<MtlMaterial> = Vec::new();
    for (_, statement, rest) in statements(text) {
        if statement == b"newmtl" {
            let name = decoded(rest).into_owned();
            materials.push(MtlMaterial { name, name_bytes: rest.to_vec(), ..MtlMaterial::default() });
        } else if let Some(material) = materials.last_mut() {
            material.add(statement, rest);
        }
    }
    materials
}

impl MtlMaterial {
    /// The textures that have a place in glTF.
    pub fn maps(&self) -> impl Iterator<Item = &MtlMap> {
        let Self { diffuse_map, emissive_map, roughness_map, metallic_map, normal_map, bump_map, .. } = self;
        [diffuse_map, emissive_map, roughness_map, metallic_map, normal_map, bump_map].into_iter().flatten()
    }

    /// The first number, as in `d 0.5` and `d -halo 0.5`.
    fn number(&mut self, statement: &str, rest: &[u8]) -> Option<f32> {
        let number = words(rest).find_map(finite_number);
        if number.is_none() {
            self.lose_broken(statement);
        }
        number
    }

    /// A colour of three numbers, or of one for all channels. None for `spectral` and `xyz`.
    fn color(&mut self, statement: &str, rest: &[u8]) -> Option<[f32; 3]> {
        let space = words(rest).next().unwrap_or_default();
        if [&b"spectral"[..], b"xyz"].contains(&space) {
            self.lost.insert(format!("{statement} ({})", String::from_utf8_lossy(space)));
            return None;
        }
        let numbers: Vec<f32> = words(rest).map_while(finite_number).take(3).collect();
        if numbers.len() < words(rest).take(3).count().max(1) {
            self.lose_broken(statement);
        }
        let r = *numbers.first()?;
        let g = *numbers.get(1).unwrap_or(&r);
        Some([r, g, *numbers.get(2).unwrap_or(&g)])
    }

    /// A statement with a number that is none or not finite.
    fn lose_broken(&mut self, statement: &str) {
        self.lost.insert(format!("{statement} (broken numbers)"));
    }

    fn add(&mut self, statement: &[u8], rest: &[u8]) {
        let name = &*shortened(&String::from_utf8_lossy(statement));
        let lower = statement.to_ascii_lowercase();
        match &lower[..] {
            b"kd" => self.diffuse = self.color(name, rest),
            b"ke" => self.emissive = self.color(name, rest),
            b"ns" => self.shininess = self.number(name, rest),
            b"pr" => self.roughness = self.number(name, rest),
            b"pm" => self.metallic = self.number(name, rest),
            b"d" => self.opacity = self.number(name, rest),
            b"tr" => self.opacity = self.number(name, rest).map(|transparency| 1.0 - transparency),
            b"map_kd" => self.diffuse_map = Some(MtlMap::parse(rest)),
            b"map_ke" => self.emissive_map = Some(MtlMap::parse(rest)),
            b"map_pr" => self.roughness_map = Some(MtlMap::parse(rest)),
            b"map_pm" => self.metallic_map = Some(MtlMap::parse(rest)),
            b"norm" | b"map_norm" | b"map_kn" => self.normal_map = Some(MtlMap::parse(rest)),
            b"bump" | b"map_bump" => self.bump_map = Some(MtlMap::parse(rest)),
            b"disp" | b"decal" | b"refl" => _ = self.lost.insert(name.to_owned()),
            other if other.starts_with(b"map_") && other != b"map_aat" => {
                self.lost.insert(name.to_owned());
            }
            _ => {}
        }
    }
}

/// A finite number.
fn finite_number(word: &[u8]) -> Option<f32> {
    str::from_utf8(word).ok()?.parse().ok().filter(|number: &f32| number.is_finite())
}
