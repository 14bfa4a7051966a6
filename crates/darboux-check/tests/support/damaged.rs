//! Damaged models: words of accessors, bytes and attributes of small models of the repository are changed,
//! each time by a seed.

use std::fs;
use std::path::Path;

use darboux::{Choice, Method};
use darboux_dice::Dice;
use serde_json::{Value, json};

use super::container::container;
use super::mistakes::MISTAKES;
use super::models::{Model, healthy_models};

/// A GLB as its JSON and its bytes.
#[derive(Clone)]
pub struct Parts {
    pub name: String,
    pub json: Value,
    pub bytes: Vec<u8>,
}

impl Parts {
    fn of_glb(name: &str, glb: &[u8]) -> Self {
        let length = u32::from_le_bytes(glb[12..16].try_into().expect("four bytes")) as usize;
        let json = serde_json::from_slice(&glb[20..20 + length]).expect("JSON");
        Self { name: name.to_owned(), json, bytes: glb.get(28 + length..).unwrap_or_default().to_vec() }
    }

    pub fn glb(&self) -> Vec<u8> {
        container(serde_json::to_vec(&self.json).expect("JSON"), self.bytes.clone())
    }
}

/// What is damaged: small models of the repository, and healthy models.
pub struct Sources {
    files: Vec<Parts>,
    healthy: Vec<Model>,
}

pub fn sources() -> Sources {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../assets/made");
    let files = [
        "degenerate.gltf",
        "quantised-sparse.glb",
        "shared-vertices-two-uv-sets.gltf",
        "skinned-morphed-mirrored.gltf",
    ];
    let read = |name: &&str| {
        let options = darboux_io::LoadOptions::default();
        let document = darboux_io::gltf::Document::open(&folder.join(name), &options).expect("an asset");
        Parts::of_glb(name, &document.to_glb().expect("a GLB"))
    };
    let small = |model: &Model| model.positions.len() <= 150;
    let healthy: Vec<Model> = healthy_models().into_iter().filter(small).collect();
    let made = healthy.iter().map(|model| Parts::of_glb(&model.name, &model.glb()));
    Sources { files: files.iter().map(read).chain(made).collect(), healthy }
}

/// Small healthy models with tangents of other methods than MikkTSpace.
pub fn sources_of_other_methods() -> Sources {
    let methods = [Method::Area, Method::AngleEdge, Method::Lengyel, Method::LengyelPerVertex];
    let models = sources().healthy;
    let of_method = |model: &Model, method: Method| Model {
        name: format!("{}, tangents by {}", model.name, method.name()),
        tangents: Some(model.computed(method, model.uv_set)),
        ..model.clone()
    };
    let healthy: Vec<Model> =
        models.iter().flat_map(|model| methods.map(|method| of_method(model, method))).collect();
    let files = healthy.iter().map(|model| Parts::of_glb(&model.name, &model.glb())).collect();
    Sources { files, healthy }
}

/// Corpus files of damaged models, each with its name.
pub fn corpus() -> Vec<(String, Vec<u8>)> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/corpus");
    let mut files: Vec<_> =
        fs::read_dir(folder).expect("the corpus").map(|entry| entry.expect("a file").path()).collect();
    files.sort();
    files.into_iter().map(|path| (path.display().to_string(), fs::read(path).expect("a file"))).collect()
}

/// A model that was damaged once or several times; none where the damage does not apply.
pub fn damaged(sources: &Sources, seed: u64) -> Parts {
    let mut dice = Dice::from_seed(seed);
    let mut parts = sources.files[dice.below(sources.files.len())].clone();
    if dice.one_in(4) {
        parts = mistaken(&sources.healthy, &mut dice);
    }
    for _ in 0..1 + dice.below(3) {
        match dice.below(8) {
            0 => remove_attribute(&mut parts, &mut dice),
            1 => change_bytes(&mut parts, &mut dice),
            2 => exchange_attributes(&mut parts, &mut dice),
            3 => change_vectors(&mut parts, &mut dice),
            4 => without_unit_length(&mut parts, &mut dice),
            _ => change_words(&mut parts, &mut dice),
        }
    }
    parts
}

/// A healthy model with one of the known mistakes.
fn mistaken(models: &[Model], dice: &mut Dice<'_>) -> Parts {
    let mut model = models[dice.below(models.len())].clone();
    let mistake = &MISTAKES[dice.below(MISTAKES.len())];
    let name = format!("{}, {}", model.name, mistake.how);
    (mistake.make)(&mut model);
    Parts::of_glb(&name, &model.glb())
}

fn primitives(json: &mut Value) -> Vec<&mut Value> {
    let meshes = json.get_mut("meshes").and_then(Value::as_array_mut);
    let meshes = meshes.into_iter().flatten();
    meshes.flat_map(|mesh| mesh["primitives"].as_array_mut().into_iter().flatten()).collect()
}

fn a_primitive<'a>(json: &'a mut Value, dice: &mut Dice<'_>) -> Option<&'a mut Value> {
    let mut all = primitives(json);
    let chosen = dice.below(all.len().max(1));
    (chosen < all.len()).then(|| all.swap_remove(chosen))
}

fn remove_attribute(parts: &mut Parts, dice: &mut Dice<'_>) {
    let Some(primitive) = a_primitive(&mut parts.json, dice) else { return };
    let attribute = dice.pick(&["NORMAL", "TANGENT", "TEXCOORD_0", "TEXCOORD_1"]);
    if dice.one_in(3) {
        primitive.as_object_mut().expect("an object").remove("targets");
    } else if let Some(attributes) = primitive["attributes"].as_object_mut() {
        attributes.remove(attribute);
    }
}

fn exchange_attributes(parts: &mut Parts, dice: &mut Dice<'_>) {
    let Some(primitive) = a_primitive(&mut parts.json, dice) else { return };
    let [a, b] = dice.pick(&[["NORMAL", "POSITION"], ["TEXCOORD_0", "TEXCOORD_1"], ["TANGENT", "TANGENT"]]);
    let attributes = &mut primitive["attributes"];
    if let (Some(first), Some(second)) = (attributes.get(a).cloned(), attributes.get(b).cloned()) {
        (attributes[a], attributes[b]) = (second, first);
    }
}

fn change_bytes(parts: &mut Parts, dice: &mut Dice<'_>) {
    for _ in 0..1 + dice.below(4) {
        let place = dice.word() as usize % parts.bytes.len().max(1);
        if let Some(byte) = parts.bytes.get_mut(place) {
            *byte = dice.below(256) as u8;
        }
    }
}

/// The place of an accessor of floats: the first byte, the number of its elements and of floats per element.
fn floats(parts: &Parts, accessor: &Value) -> Option<(usize, usize, usize)> {
    let json = &parts.json;
    let accessor = &json["accessors"][accessor.as_u64()? as usize];
    let view = &json["bufferViews"][accessor["bufferView"].as_u64()? as usize];
    let components = match accessor["type"].as_str()? {
        "VEC2" => 2,
        "VEC3" => 3,
        "VEC4" => 4,
        _ => return None,
    };
    let is_packed = accessor["componentType"] == json!(5126) && view.get("byteStride").is_none();
    let start = |value: &Value| value.get("byteOffset").and_then(Value::as_u64).unwrap_or(0) as usize;
    is_packed.then(|| {
        (start(accessor) + start(view), accessor["count"].as_u64().unwrap_or(0) as usize, components)
    })
}

fn an_attribute(parts: &mut Parts, dice: &mut Dice<'_>) -> Option<(usize, usize, usize)> {
    let wanted = dice.pick(&["NORMAL", "TANGENT", "TANGENT", "TEXCOORD_0", "POSITION"]);
    let accessor = a_primitive(&mut parts.json, dice)?["attributes"].get(wanted)?.clone();
    let place = floats(parts, &accessor)?;
    (place.0 + 4 * place.1 * place.2 <= parts.bytes.len() && place.1 > 0).then_some(place)
}

fn change_words(parts: &mut Parts, dice: &mut Dice<'_>) {
    let Some((start, count, components)) = an_attribute(parts, dice) else { return };
    for _ in 0..1 + dice.below(6) {
        let place = start + 4 * (dice.word() as usize % (count * components));
        let value = dice.pick(&[
            0.0,
            -0.0,
            1.0,
            -1.0,
            0.5,
            2.0,
            -3.0,
            1e-20,
            1e20,
            f32::NAN,
            f32::INFINITY,
            0.9,
            0.05,
        ]);
        let value = if dice.one_in(3) { dice.uniform() } else { value };
        parts.bytes[place..place + 4].copy_from_slice(&value.to_le_bytes());
    }
}

/// Scales or negates or turns vectors of a part of an attribute.
fn change_vectors(parts: &mut Parts, dice: &mut Dice<'_>) {
    let Some((start, count, components)) = an_attribute(parts, dice) else { return };
    let (every, change) = (1 + dice.below(8), dice.below(5));
    for element in (0..count).step_by(every) {
        let at = |i: usize| start + 4 * (element * components + i);
        let read = |bytes: &[u8], i: usize| {
            f32::from_le_bytes(bytes[at(i)..at(i) + 4].try_into().expect("four bytes"))
        };
        let old: Vec<f32> = (0..components).map(|i| read(&parts.bytes, i)).collect();
        let mut new = old.clone();
        match change {
            0 => new[0] = -old[0],
            1 => new.iter_mut().for_each(|x| *x = -*x),
            2 => new.swap(0, 1),
            3 => new[components - 1] = -old[components - 1],
            _ => new.iter_mut().take(3).for_each(|x| *x *= 0.7),
        }
        for (i, x) in new.into_iter().enumerate() {
            parts.bytes[at(i)..at(i) + 4].copy_from_slice(&x.to_le_bytes());
        }
    }
}

fn without_unit_length(parts: &mut Parts, dice: &mut Dice<'_>) {
    let Some(accessor) = a_primitive(&mut parts.json, dice)
        .and_then(|primitive| primitive["attributes"].get("NORMAL").cloned())
    else {
        return;
    };
    let Some((start, count, 3)) = floats(parts, &accessor) else { return };
    if start + 12 * count > parts.bytes.len() || count == 0 {
        return;
    }
    for _ in 0..1 + dice.below(count.min(4)) {
        let place = start + 12 * (dice.word() as usize % count);
        let scale = dice.pick(&[0.0, 0.5, 3.0, -1.0]);
        for i in 0..3 {
            let word = &mut parts.bytes[place + 4 * i..place + 4 * i + 4];
            let x = scale * f32::from_le_bytes(word.try_into().expect("four bytes"));
            word.copy_from_slice(&x.to_le_bytes());
        }
    }
}
