//! Writes the verdicts on the normal maps below folders, as they are, with green inverted, and with red and
//! green exchanged: `real_maps FOLDER ... [--list FILE] [--page FILE]`.
//!
//! Normal maps are the images that materials of glTF files use as such, and image files with "normal" in
//! their names. Each content is judged once. With `--list FILE`, instead, the maps of a list below one
//! folder, whose truth is known: how often the verdicts are right.

mod corpus;

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use darboux::{MapJudgement, MapVerdict, TexelLayout, judge_normal_map};
use darboux_io::LoadOptions;
use darboux_io::gltf::Document;
use darboux_io::image::{DecodeLimits, RgbaImage};

fn main() -> ExitCode {
    let mut words: Vec<String> = std::env::args().skip(1).collect();
    let mut option = |name: &str| {
        let at = words.iter().position(|word| word == name)?;
        words.drain(at..(at + 2).min(words.len())).nth(1)
    };
    let [page, list] = ["--page", "--list"].map(&mut option);
    let text = match list {
        Some(list) => corpus::page(Path::new(&list), Path::new(words.first().map_or(".", String::as_str))),
        None => {
            let maps: Vec<RealMap> = words.iter().flat_map(|folder| maps_below(Path::new(folder))).collect();
            Ok(text(&maps))
        }
    };
    let text = match text {
        Ok(text) => text,
        Err(error) => {
            eprintln!("{error}");
            return ExitCode::FAILURE;
        }
    };
    match page {
        None => print!("{text}"),
        Some(path) => {
            if let Err(error) = fs::write(&path, text) {
                eprintln!("{path:?} cannot be written: {error}");
                return ExitCode::FAILURE;
            }
        }
    }
    ExitCode::SUCCESS
}

/// A normal map and the judgements on it.
struct RealMap {
    name: String,
    texels: Vec<[u8; 4]>,
    size: [usize; 2],
    as_it_is: MapJudgement,
    inverted: MapJudgement,
    exchanged: MapJudgement,
}

/// The maps below a folder, each content once.
fn maps_below(folder: &Path) -> Vec<RealMap> {
    let mut maps: Vec<RealMap> = Vec::new();
    let name_of = |path: &Path| path.strip_prefix(folder).unwrap_or(path).display().to_string();
    for path in files_below(folder) {
        for (place, file) in normal_maps(&path) {
            let Ok(image) = RgbaImage::decode(&file, &DecodeLimits::default()) else { continue };
            if maps.iter().all(|map| map.texels != image.texels) {
                maps.push(RealMap::new(format!("{}{place}", name_of(&path)), image));
            }
        }
    }
    maps
}

/// All files below a folder, or the file itself, sorted.
fn files_below(path: &Path) -> Vec<PathBuf> {
    let Ok(entries) = fs::read_dir(path) else { return vec![path.to_owned()] };
    let mut paths: Vec<PathBuf> = entries.flatten().map(|entry| entry.path()).collect();
    paths.sort();
    paths.iter().flat_map(|path| files_below(path)).collect()
}

/// The normal maps in a file, each with its place in the file.
fn normal_maps(path: &Path) -> Vec<(String, Vec<u8>)> {
    let name = path.file_name().map(|name| name.to_string_lossy().to_lowercase()).unwrap_or_default();
    let has = |extensions: &[&str]| extensions.iter().any(|extension| name.ends_with(extension));
    if has(&[".png", ".jpg", ".jpeg", ".webp"]) && name.contains("normal") {
        return fs::read(path).into_iter().map(|file| (String::new(), file)).collect();
    }
    if !has(&[".gltf", ".glb", ".vrm"]) {
        return Vec::new();
    }
    let Ok(document) = Document::open(path, &LoadOptions::default()) else { return Vec::new() };
    let materials = document.materials().unwrap_or_default();
    let used = materials.iter().filter_map(|material| material.normal_texture.as_ref()?.image);
    let images: BTreeSet<usize> = used.collect();
    let bytes =
        |image: usize| Some((format!(", image {image}"), document.image_bytes(image).ok()?.into_owned()));
    images.into_iter().filter_map(bytes).collect()
}

impl RealMap {
    fn new(name: String, image: RgbaImage) -> Self {
        let size = [image.width, image.height].map(|side| side as usize);
        let judged = |change: fn([u8; 4]) -> [u8; 4]| {
            let texels: Vec<[u8; 4]> = image.texels.iter().copied().map(change).collect();
            judge_normal_map(&texels, size, TexelLayout::RGBA).expect("the image is whole")
        };
        Self {
            name,
            size,
            as_it_is: judged(|texel| texel),
            inverted: judged(|[r, g, b, a]| [r, 255 - g, b, a]),
            exchanged: judged(|[r, g, b, a]| [g, r, b, a]),
            texels: image.texels,
        }
    }

    fn row(&self) -> String {
        let shown = |judgement: &MapJudgement| {
            format!("{:?}, {:.1} %", judgement.verdict, 100.0 * f64::from(judgement.confidence))
        };
        let Self { name, size: [width, height], as_it_is, .. } = self;
        let [verdict, inverted, exchanged] = [as_it_is, &self.inverted, &self.exchanged].map(shown);
        let (correlation, z_score, ratio) =
            (as_it_is.correlation, as_it_is.z_score, as_it_is.log_energy_ratio);
        format!(
            "| {name} | {width} x {height} | {verdict} | {correlation:.2} | {z_score:.1} | {ratio:.2} | {inverted} | {exchanged} |\n"
        )
    }
}

fn text(maps: &[RealMap]) -> String {
    let count = |verdict| maps.iter().filter(|map| map.as_it_is.verdict == verdict).count();
    let opposite = |verdict| match verdict {
        MapVerdict::OpenGl => MapVerdict::DirectX,
        MapVerdict::DirectX => MapVerdict::OpenGl,
        other => other,
    };
    let follows = maps.iter().filter(|map| map.inverted.verdict == opposite(map.as_it_is.verdict)).count();
    let decided: Vec<&RealMap> = maps
        .iter()
        .filter(|map| matches!(map.as_it_is.verdict, MapVerdict::OpenGl | MapVerdict::DirectX))
        .collect();
    let noticed = decided.iter().filter(|map| map.exchanged.has_exchanged_channels()).count();
    let rows: String = maps.iter().map(RealMap::row).collect();
    format!(
        "\
# Verdicts on real normal maps

`judge_normal_map` on the {} normal maps, each content once: as they are, with green inverted, and with red and
green exchanged. Generated maps, whose truth is known, are judged by `cargo xtask maps`.

As they are: {} OpenGL, {} DirectX, {} no gradient, {} flat, {} undecided. With green inverted, the verdict is the opposite one (or the same, where there is none) for {follows} of
{}. With red and green exchanged, the exchange is seen for {noticed} of the {} that are decided. The ratio is half the natural logarithm of the energy of the unmixed derivatives over
that of the mixed ones: where it is near 0, the texels alone cannot show an exchange.

| map | size | verdict | correlation | z score | ratio | with green inverted | with red and green exchanged |
|---|---|---|--:|--:|--:|---|---|
{rows}",
        maps.len(),
        count(MapVerdict::OpenGl),
        count(MapVerdict::DirectX),
        count(MapVerdict::NoGradient),
        count(MapVerdict::Flat),
        count(MapVerdict::CannotTell),
        maps.len(),
        decided.len(),
    )
}
