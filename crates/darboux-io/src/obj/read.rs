//! Reads an OBJ: checks its indices, parses it, and hands meshes and materials to the document builder.

use std::path::Path;

use tobj::{LoadError, Mesh, Model};

use super::companions::{self, folder_of};
use super::document::DocumentBuilder;
use super::faces::triangulate;
use super::libraries::MaterialLibraries;
use crate::error::ContentError;
use crate::gltf::Document;
use crate::{Error, LoadOptions, paths};

/// An OBJ as a document, and what the document lacks.
#[derive(Debug)]
pub struct ObjModel {
    /// One mesh and one node per object or group with faces. Textures are embedded; `v` points down, as in glTF.
    pub document: Document,
    /// One sentence for each library, texture or attribute that was left out.
    pub warnings: Vec<String>,
}

/// The estimate for an object or group: one mesh, one node, and up to four accessors and buffer views.
const BYTES_PER_OBJECT: usize = 16 << 10;

/// Reads an OBJ with the material libraries and textures in its folder or below.
///
/// Polygons become triangles, concave ones too; points and lines are left out. Errors: a file that cannot be read, is not an OBJ, or has no faces; more
/// objects than [`LoadOptions::memory_limit`] permits; a document larger than a GLB can be.
pub fn read(path: &Path, options: &LoadOptions) -> Result<ObjModel, Error> {
    let shown = path.display().to_string();
    let invalid = |problem: String| ContentError::invalid("", problem).in_file(&shown);
    let libraries = MaterialLibraries::new(folder_of(path)?);
    let bytes = paths::resolve_input(path).and_then(|input| {
        paths::read_resolved(&input).map_err(|source| Error::Read { file: path.to_owned(), source })
    })?;
    // Comments and names may be in any encoding.
    let text = String::from_utf8_lossy(&bytes);
    let parser_options =
        tobj::LoadOptions { triangulate: false, single_index: true, ignore_points: true, ignore_lines: true };
    let (models, folded_faces) = check_indices(&text)
        .and_then(|()| {
            let load = |line: &Path| Ok(libraries.load(line));
            let (mut models, _) = tobj::load_obj_buf(&mut text.as_bytes(), &parser_options, load)?;
            let folded_faces = triangulate(&mut models)?;
            Ok((models, folded_faces))
        })
        .map_err(|error| invalid(format!("is not a valid OBJ ({error}); export it again")))?;

    let limit = options.budget(bytes.len(), 0);
    if models.len().saturating_mul(BYTES_PER_OBJECT) > limit.bytes {
        let what = format!("has {} objects and groups, which need", models.len());
        return Err(ContentError::unsupported("", limit.exceeded(&what)).in_file(&shown));
    }
    let (materials, mut warnings) = libraries.into_parts();
    let mut builder = DocumentBuilder::default();
    materials.iter().for_each(|material| builder.add_material(material));
    models.iter().filter(|model| !model.mesh.indices.is_empty()).for_each(|model| builder.add_mesh(model));
    if !builder.has_meshes() {
        return Err(invalid(companions::NO_FACES.to_owned()));
    }
    warnings.append(&mut builder.warnings);
    warnings.extend(incomplete_attributes(&models));
    warnings.extend(folded_warning(folded_faces));
    let glb = builder.into_glb().map_err(|error| error.in_file(&shown))?;
    let document = Document::from_bytes(&shown, glb, None, options)?;
    Ok(ObjModel { document, warnings })
}

/// Rejects indices that overflow in the parser, which multiplies them without a check.
///
/// Errors: a negative index that points before the first element, or a positive one greater than the length of the text.
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

/// A sentence if there are faces that no triangles cover without folds.
fn folded_warning(faces: usize) -> Option<String> {
    let faces = match faces {
        0 => return None,
        1 => "1 face crosses itself or is too large to cut, and its".to_owned(),
        count => format!("{count} faces cross themselves or are too large to cut, and their"),
    };
    Some(format!("{faces} triangles overlap; split such faces in a modelling program"))
}

/// One sentence per attribute that some meshes have at some of their corners only, and therefore lose.
fn incomplete_attributes(models: &[Model]) -> impl Iterator<Item = String> {
    let is_incomplete = |mesh: &Mesh, numbers: &[f32], components: usize| {
        !numbers.is_empty() && numbers.len() / components < mesh.positions.len() / 3
    };
    let meshes = || models.iter().map(|model| &model.mesh);
    let uvs = meshes().filter(|mesh| is_incomplete(mesh, &mesh.texcoords, 2)).count();
    let normals = meshes().filter(|mesh| is_incomplete(mesh, &mesh.normals, 3)).count();
    [(uvs, "UVs"), (normals, "normals")].into_iter().filter(|(meshes, _)| *meshes > 0).map(
        |(meshes, attribute)| {
            let meshes = if meshes == 1 { "1 mesh has".to_owned() } else { format!("{meshes} meshes have") };
            format!("{meshes} {attribute} at some corners only; they are left out")
        },
    )
}
