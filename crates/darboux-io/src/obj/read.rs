//! An OBJ as a document, with the materials and textures of its folder.

use std::cell::RefCell;
use std::collections::HashMap;
use std::fs;
use std::path::{Path, PathBuf};

use darboux_io::gltf::{Document, LoadOptions};
use darboux_render::{is_colored, linear_of_srgb};
use serde_json::{Value, json};
use tobj::{LoadError, Material, Mesh, Model};

use crate::batch::counted;
use crate::view::obj::{folder_of, named, texture};

/// Reads an OBJ; gives what is odd about it, too. v runs down then, as in glTF. The error is a sentence.
pub fn open(path: &Path) -> Result<(Document, Vec<String>), String> {
    let shown = path.display().to_string();
    let folder = folder_of(path)?;
    let bytes = fs::read(path).map_err(|error| format!("{shown}: cannot be read: {error}"))?;
    let options =
        tobj::LoadOptions { triangulate: true, single_index: true, ignore_points: true, ignore_lines: true };
    let libraries = Libraries { folder, looks: RefCell::default(), warnings: RefCell::default() };
    // Comments and names may be in any encoding.
    let text = String::from_utf8_lossy(&bytes);
    let loaded = check_indices(&text)
        .and_then(|()| tobj::load_obj_buf(&mut text.as_bytes(), &options, |line| Ok(libraries.read(line))));
    let broken = |error: LoadError| format!("{shown}: is no OBJ that can be read ({error}); export it again");
    let (models, _) = loaded.map_err(broken)?;
    let mut glb = Glb { warnings: libraries.warnings.take(), ..Glb::default() };
    libraries.looks.take().iter().for_each(|look| glb.add_material(look));
    models.iter().filter(|model| !model.mesh.indices.is_empty()).for_each(|model| glb.add_mesh(model));
    glb.warnings.extend(partial(&models));
    if glb.meshes.is_empty() {
        return Err(format!("{shown}: has no faces as an OBJ has them; export it again"));
    }
    let warnings = std::mem::take(&mut glb.warnings);
    let bytes =
        glb.into_bytes().ok_or_else(|| format!("{shown}: is too large; export it as .glb in parts"))?;
    let document = Document::from_bytes(&shown, bytes, None, &LoadOptions::default());
    Ok((document.map_err(|error| error.to_string())?, warnings))
}

/// The reader multiplies indices unchecked. Errors: one below 0 that leads before the first element, or one past all that a text of this
/// length can have.
fn check_indices(text: &str) -> Result<(), LoadError> {
    const KINDS: [&str; 3] = ["v", "vt", "vn"];
    let mut counts = [0; 3];
    for line in text.lines() {
        let mut words = line.split_whitespace();
        let statement = words.next().unwrap_or_default();
        if let Some(kind) = KINDS.iter().position(|kind| *kind == statement) {
            counts[kind] += 1;
        }
        let corners = words.filter(|_| ["f", "l"].contains(&statement));
        for (kind, index) in corners.flat_map(|corner| corner.split('/').take(3).enumerate()) {
            let Ok(index) = index.parse::<isize>() else { continue };
            let most = if index < 0 { counts[kind] } else { text.len() };
            if index.unsigned_abs() > most {
                let errors = [
                    LoadError::FaceVertexOutOfBounds,
                    LoadError::FaceTexCoordOutOfBounds,
                    LoadError::FaceNormalOutOfBounds,
                ];
                return Err(errors[kind]);
            }
        }
    }
    Ok(())
}

/// What is left out because not all corners of a mesh have it: a sentence each.
fn partial(models: &[Model]) -> impl Iterator<Item = String> {
    let is_partial = |mesh: &Mesh, numbers: &[f32], each: usize| {
        !numbers.is_empty() && numbers.len() / each < mesh.positions.len() / 3
    };
    let meshes = || models.iter().map(|model| &model.mesh);
    let uvs = meshes().filter(|mesh| is_partial(mesh, &mesh.texcoords, 2)).count();
    let normals = meshes().filter(|mesh| is_partial(mesh, &mesh.normals, 3)).count();
    [(uvs, "UVs"), (normals, "normals")].into_iter().filter(|(meshes, _)| *meshes > 0).map(
        |(meshes, what)| {
            let meshes = counted(meshes, "mesh has", "meshes have");
            format!("{meshes} {what} at some corners only; drawn without them")
        },
    )
}

/// A material, its textures by their paths.
struct Look {
    name: String,
    /// In sRGB.
    color: [f32; 3],
    base: Option<PathBuf>,
    /// Of the statement `norm`.
    normal: Option<PathBuf>,
    /// Of the statements for heights, where many programs write normal maps.
    bump: Option<PathBuf>,
}

/// The material libraries of a folder.
struct Libraries {
    folder: PathBuf,
    /// All materials, in the order in which they were read, which is that of their indices.
    looks: RefCell<Vec<Look>>,
    warnings: RefCell<Vec<String>>,
}

impl Libraries {
    /// The materials of the libraries that a line names, and their places by name.
    fn read(&self, line: &Path) -> (Vec<Material>, HashMap<String, usize>) {
        let line = line.to_string_lossy();
        let mut materials = Vec::new();
        let libraries = named(&self.folder, line.as_bytes());
        if libraries.is_empty() {
            self.warn(format!("{line} is not in the model's folder, and its materials are missing"));
        }
        for library in libraries {
            match read_library(&library.path) {
                Ok(found) => {
                    self.looks.borrow_mut().extend(found.iter().map(|found| self.look(&library.name, found)));
                    materials.extend(found);
                }
                Err(problem) => self.warn(format!("{}: {problem}", library.name)),
            }
        }
        let places = materials.iter().enumerate().map(|(at, found)| (found.name.clone(), at)).collect();
        (materials, places)
    }

    fn look(&self, library: &str, material: &Material) -> Look {
        let located = |line: Option<&String>| {
            let line = line?;
            let found = texture(&self.folder, library, line.as_bytes());
            if found.is_none() {
                self.warn(format!("{library}: {line} is not in the model's folder; drawn without it"));
            }
            Some(found?.path)
        };
        Look {
            name: material.name.clone(),
            color: material.diffuse.unwrap_or([1.0; 3]),
            base: located(material.diffuse_texture.as_ref()),
            normal: located(material.unknown_param.get("norm")),
            bump: located(material.normal_texture.as_ref()),
        }
    }

    fn warn(&self, sentence: String) {
        self.warnings.borrow_mut().push(sentence);
    }
}

/// The materials of a library. The error is a sentence without its subject.
fn read_library(path: &Path) -> Result<Vec<Material>, String> {
    let bytes =
        fs::read(path).map_err(|error| format!("cannot be read: {error}; its materials are missing"))?;
    let text = String::from_utf8_lossy(&bytes);
    // The reader panics at colours with one or two numbers.
    let is_whole = |line: &str| {
        let mut words = line.split_whitespace();
        !["Ka", "Kd", "Ks", "Ke"].contains(&words.next().unwrap_or_default()) || words.count() >= 3
    };
    let loaded = match text.lines().all(is_whole) {
        true => tobj::load_mtl_buf(&mut text.as_bytes()),
        false => Err(LoadError::ColorParseError),
    };
    let (materials, _) = loaded.map_err(|error| format!("cannot be read ({error}); export it again"))?;
    Ok(materials)
}

/// A document as it grows.
#[derive(Default)]
struct Glb {
    bytes: Vec<u8>,
    views: Vec<Value>,
    accessors: Vec<Value>,
    images: Vec<Value>,
    texture_of: HashMap<PathBuf, usize>,
    materials: Vec<Value>,
    meshes: Vec<Value>,
    warnings: Vec<String>,
}

impl Glb {
    fn add_material(&mut self, look: &Look) {
        // What is no number is as if it were not said.
        let said = |channel: f32| if channel.is_finite() { f64::from(channel.clamp(0.0, 1.0)) } else { 1.0 };
        let [r, g, b] = look.color.map(|channel| linear_of_srgb(said(channel)));
        let base = look.base.as_deref().and_then(|path| self.texture(path));
        let normal = look.normal.as_deref().or_else(|| self.normal_map_in_bump(look));
        let normal = normal.and_then(|path| self.texture(path));
        let mut material =
            json!({"name": look.name, "pbrMetallicRoughness": {"baseColorFactor": [r, g, b, 1.0]}});
        if let Some(index) = base {
            material["pbrMetallicRoughness"]["baseColorTexture"] = json!({"index": index});
        }
        if let Some(index) = normal {
            material["normalTexture"] = json!({"index": index});
        }
        self.materials.push(material);
    }

    /// The bump map of a material, unless it is grey.
    fn normal_map_in_bump<'a>(&mut self, look: &'a Look) -> Option<&'a Path> {
        let path = look.bump.as_deref()?;
        if fs::read(path).ok().and_then(|bytes| is_colored(&bytes)) == Some(false) {
            self.warnings.push(format!(
                "the bump map of {} is grey, so it holds heights, which are not shown; normal maps are coloured",
                look.name
            ));
            return None;
        }
        Some(path)
    }

    /// The index of the texture of a file; none where it cannot be read.
    fn texture(&mut self, path: &Path) -> Option<usize> {
        if let Some(&index) = self.texture_of.get(path) {
            return Some(index);
        }
        let bytes = match fs::read(path) {
            Ok(bytes) => bytes,
            Err(error) => {
                self.warnings.push(format!("{}: cannot be read: {error}; drawn without it", path.display()));
                return None;
            }
        };
        let view = self.view(&bytes);
        self.images.push(json!({"bufferView": view}));
        self.texture_of.insert(path.to_owned(), self.images.len() - 1);
        Some(self.images.len() - 1)
    }

    fn add_mesh(&mut self, model: &Model) {
        let mesh = &model.mesh;
        let count = mesh.positions.len() / 3;
        let mut attributes = json!({"POSITION": self.floats(&mesh.positions, "VEC3")});
        if mesh.normals.len() == 3 * count {
            attributes["NORMAL"] = self.floats(&mesh.normals, "VEC3").into();
        }
        if mesh.texcoords.len() == 2 * count {
            let down: Vec<f32> =
                mesh.texcoords.as_chunks().0.iter().flat_map(|&[u, v]| [u, 1.0 - v]).collect();
            attributes["TEXCOORD_0"] = self.floats(&down, "VEC2").into();
        }
        let indices: Vec<u8> = mesh.indices.iter().flat_map(|index| index.to_le_bytes()).collect();
        let indices = self.accessor(&indices, UNSIGNED_INT, mesh.indices.len(), "SCALAR");
        let mut primitive = json!({"attributes": attributes, "indices": indices});
        if let Some(material) = mesh.material_id.filter(|&material| material < self.materials.len()) {
            primitive["material"] = material.into();
        }
        self.meshes.push(json!({"name": model.name, "primitives": [primitive]}));
    }

    fn floats(&mut self, floats: &[f32], kind: &str) -> usize {
        let bytes: Vec<u8> = floats.iter().flat_map(|x| x.to_le_bytes()).collect();
        let components = if kind == "VEC2" { 2 } else { 3 };
        self.accessor(&bytes, FLOAT, floats.len() / components, kind)
    }

    fn accessor(&mut self, bytes: &[u8], component: u32, count: usize, kind: &str) -> usize {
        let view = self.view(bytes);
        self.accessors
            .push(json!({"bufferView": view, "componentType": component, "count": count, "type": kind}));
        self.accessors.len() - 1
    }

    fn view(&mut self, bytes: &[u8]) -> usize {
        self.bytes.resize(self.bytes.len().next_multiple_of(4), 0);
        self.views.push(json!({"buffer": 0, "byteOffset": self.bytes.len(), "byteLength": bytes.len()}));
        self.bytes.extend(bytes);
        self.views.len() - 1
    }

    /// The document as a GLB; none where that would be larger than GLBs can be.
    fn into_bytes(mut self) -> Option<Vec<u8>> {
        self.bytes.resize(self.bytes.len().next_multiple_of(4), 0);
        let nodes: Vec<Value> = (0..self.meshes.len()).map(|mesh| json!({"mesh": mesh})).collect();
        let textures: Vec<Value> = (0..self.images.len()).map(|image| json!({"source": image})).collect();
        let mut document = json!({
            "asset": {"version": "2.0"},
            "nodes": nodes,
            "meshes": self.meshes,
            "accessors": self.accessors,
            "bufferViews": self.views,
            "buffers": [{"byteLength": self.bytes.len()}],
        });
        for (name, list) in [("materials", self.materials), ("images", self.images), ("textures", textures)] {
            if !list.is_empty() {
                document[name] = list.into();
            }
        }
        glb_of(document.to_string(), &self.bytes)
    }
}

/// OpenGL's numbers, which glTF uses.
const UNSIGNED_INT: u32 = 5125;
const FLOAT: u32 = 5126;

/// The container (glTF 2.0, 4.4).
fn glb_of(json: String, bytes: &[u8]) -> Option<Vec<u8>> {
    let mut json = json.into_bytes();
    json.resize(json.len().next_multiple_of(4), b' ');
    let lens = [12 + 8 + json.len() + 8 + bytes.len(), json.len(), bytes.len()].map(u32::try_from);
    let [Ok(whole), Ok(text), Ok(binary)] = lens else { return None };
    let word = u32::to_le_bytes;
    let head = [&b"glTF"[..], &word(2), &word(whole), &word(text), b"JSON"].concat();
    Some([&head, &json[..], &word(binary), b"BIN\0", bytes].concat())
}

#[cfg(test)]
mod tests {
    use super::*;

    const OBJ: &str = "mtllib a.mtl\no quad\nv 0 0 0\nv 1 0 0\nv 1 1 0 1\nvt 0 0\nvt 1 0\nvt 1 1\nvn 0 0 1\n\
        usemtl a\ng one\nf 1/1/1 2/2/1 -1/-1/-1\nf 1//1 2//1 3//1 1//1 2//1\nl 1 2\n";
    const MTL: &str =
        "newmtl a\nKd 0.5 0.5 0.5\nNs 10\nillum 2\nmap_Kd a.png\nbump -bm 1 a.png\nnewmtl b\nd 0.5\n";

    /// What is put in place of a word: borders of numbers, what is missing, and what is no text.
    const WORDS: [&[u8]; 22] = [
        b"",
        b" ",
        b"\n",
        b"/",
        b"//",
        b"1/2/3/4",
        b"0",
        b"-1",
        b"-2/-3/-4",
        b"1/-9/1",
        b"1/1/-9",
        b"99",
        b"9223372036854775807",
        b"1/9223372036854775807",
        b"1/1/9223372036854775807",
        b"-9223372036854775808",
        b"1/1/-6148914691236517207",
        b"18446744073709551616",
        b"nan",
        b"1e999",
        b"\xFF\x00\xFE",
        b"\\",
    ];

    /// The text with some words replaced, removed or repeated; `random`: numbers below its argument.
    fn mutated(text: &str, random: &mut impl FnMut(usize) -> usize) -> Vec<u8> {
        let mut words: Vec<Vec<u8>> = text.split_inclusive([' ', '\n']).map(|word| word.into()).collect();
        for _ in 0..1 + random(3) {
            let at = random(words.len());
            let last = *words[at].last().expect("no word is empty");
            words[at] = match random(8) {
                0 => Vec::new(),
                1 => words[at].repeat(1 + random(2000)),
                2 => words[random(words.len())].clone(),
                _ => WORDS[random(WORDS.len())].to_vec(),
            };
            words[at].push(last);
        }
        words.concat()
    }

    #[test]
    fn odd_files_are_models_or_sentences() {
        let folder = tempfile::tempdir().unwrap();
        let [obj, mtl] = ["a.obj", "a.mtl"].map(|name| folder.path().join(name));
        let mut state = 1u64;
        let mut random = |below: usize| {
            state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (state >> 33) as usize % below
        };
        let [mut models, mut sentences] = [0; 2];
        for case in 0..600 {
            let [text, library] = match case % 2 {
                0 => [mutated(OBJ, &mut random), MTL.into()],
                _ => [OBJ.into(), mutated(MTL, &mut random)],
            };
            fs::write(&obj, text).unwrap();
            fs::write(&mtl, library).unwrap();
            match open(&obj) {
                Ok((mut document, _)) => {
                    darboux_render::Model::read(&mut document).unwrap();
                    models += 1;
                }
                Err(sentence) => {
                    assert!(sentence.contains("a.obj: ") && !sentence.contains('\n'), "{sentence}");
                    sentences += 1;
                }
            }
        }
        assert!(models > 100 && sentences > 50, "{models} models, {sentences} sentences");
    }

    /// What is odd about an OBJ with a library.
    fn warnings(obj: &str, library: &str) -> Vec<String> {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join("a.mtl"), library).unwrap();
        fs::write(folder.path().join("a.obj"), format!("mtllib a.mtl\n{obj}")).unwrap();
        open(&folder.path().join("a.obj")).unwrap().1
    }

    #[test]
    fn colours_of_one_number_are_said() {
        let said = warnings("v 0 0 0\nf 1 1 1\n", "newmtl a\nKd 0.5\n");
        assert!(said.len() == 1 && said[0].starts_with("a.mtl: cannot be read (color"), "{said:?}");
    }

    #[test]
    fn attributes_of_some_corners_are_said() {
        let elements = "v 0 0 0\nv 1 0 0\nv 1 1 0\nvt 0 0\nvn 0 0 1\n";
        let said = |faces: &str| warnings(&format!("{elements}{faces}"), "");
        assert_eq!(said("f 1/1/1 2/1/1 3/1/1\n"), [""; 0]);
        assert_eq!(said("f 1 2 3\n"), [""; 0]);
        let [uvs, normals] =
            ["UVs", "normals"].map(|what| format!("{what} at some corners only; drawn without them"));
        assert_eq!(said("f 1/1/1 2//1 3/1/1\n"), [format!("1 mesh has {uvs}")]);
        assert_eq!(
            said("f 1/1/1 2 3/1/1\no b\nf 1/1/1 2/1 3/1/1\n"),
            [format!("1 mesh has {uvs}"), format!("2 meshes have {normals}")]
        );
    }

    #[test]
    #[cfg(unix)]
    fn unreadable_libraries_are_said() {
        use std::os::unix::fs::PermissionsExt;

        let folder = tempfile::tempdir().unwrap();
        let [obj, mtl] = ["a.obj", "a.mtl"].map(|name| folder.path().join(name));
        fs::write(&obj, "mtllib a.mtl\nv 0 0 0\nf 1 1 1\n").unwrap();
        fs::write(&mtl, MTL).unwrap();
        fs::set_permissions(&mtl, fs::Permissions::from_mode(0o000)).unwrap();
        // Administrators can read everything.
        let is_readable = fs::read(&mtl).is_ok();
        let (_, said) = open(&obj).unwrap();
        assert_eq!(
            said.iter().any(|said| said.starts_with("a.mtl: cannot be read: ")),
            !is_readable,
            "{said:?}"
        );
    }
}
