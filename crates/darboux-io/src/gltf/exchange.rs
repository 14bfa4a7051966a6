//! Writes documents as PLY and OBJ, which hold the surfaces of a scene and little else. What they cannot hold
//! is listed.

mod format;
mod left_out;
mod obj;
mod ply;
mod surfaces;

use super::Document;
use super::segments::Segment;
use crate::Error;
use crate::error::ContentError;
use left_out::LeftOut;
use surfaces::Surface;

pub(super) use format::ExchangeFormat;

/// A PLY or an OBJ, and what it leaves out.
pub(super) struct ExchangeFile<'a> {
    pub segments: Vec<Segment<'a>>,
    /// The text of the material library of an OBJ, if there are materials.
    pub library: Option<String>,
}

/// The surfaces of a document. Errors: invalid data; more corners than the memory limit permits; no faces in
/// the scene.
pub(super) fn surfaces(document: &Document) -> Result<Vec<Surface>, Error> {
    let surfaces = surfaces::of(document)?;
    if surfaces.is_empty() {
        let has_primitives = document.meshes().iter().any(|mesh| !mesh.primitives.is_empty());
        let advice = if has_primitives { "put its meshes into the scene, or " } else { "" };
        let problem = format!("has no faces, and a PLY or an OBJ nothing else; {advice}write a .glb");
        return Err(ContentError::unsupported("scene", problem).in_file(document.name()));
    }
    Ok(surfaces)
}

/// The content of an exchange file. `library`: the name of the material library. `textures`: the path of each
/// image as the library spells it.
pub(super) fn content<'a>(
    document: &Document,
    surfaces: &[Surface],
    format: ExchangeFormat,
    library: &str,
    textures: &[Option<String>],
) -> Result<ExchangeFile<'a>, Error> {
    Ok(match format {
        ExchangeFormat::Ply => {
            ExchangeFile { segments: vec![Segment::Owned(ply::text(surfaces))], library: None }
        }
        ExchangeFormat::Obj => {
            let materials = obj::materials(document, surfaces, textures)?;
            let text = obj::text(surfaces, &materials, library);
            let library = (!materials.names.is_empty()).then_some(materials.library);
            ExchangeFile { segments: vec![Segment::Owned(text.into_bytes())], library }
        }
    })
}

/// What an exchange file does not hold of a document: a noun phrase each.
pub(super) fn left_out(document: &Document, format: ExchangeFormat) -> Result<Vec<String>, Error> {
    LeftOut::of(document, format).map(LeftOut::phrases)
}

/// The images that the materials of an OBJ refer to, in the order of their indices.
pub(super) fn images_of_library(document: &Document) -> Result<Vec<usize>, Error> {
    obj::images(document)
}
