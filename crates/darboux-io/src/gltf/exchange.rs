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
use left_out::LeftOut;

pub(super) use format::ExchangeFormat;

/// A PLY or an OBJ, and what it leaves out.
pub(super) struct ExchangeFile<'a> {
    pub segments: Vec<Segment<'a>>,
    /// The text of the material library of an OBJ, if there are materials.
    pub library: Option<String>,
}

/// The content of an exchange file. `library`: the name of the material library. `textures`: the path of each
/// image as the library spells it.
pub(super) fn content<'a>(
    document: &Document,
    format: ExchangeFormat,
    library: &str,
    textures: &[Option<String>],
) -> Result<ExchangeFile<'a>, Error> {
    let surfaces = surfaces::of(document)?;
    Ok(match format {
        ExchangeFormat::Ply => {
            ExchangeFile { segments: vec![Segment::Owned(ply::text(&surfaces))], library: None }
        }
        ExchangeFormat::Obj => {
            let materials = obj::materials(document, textures)?;
            let text = obj::text(&surfaces, &materials, library);
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
