//! The low model with its maps beside the high ones, from four sides.

use darboux_gpu::Gpu;
use darboux_io::gltf::Document;
use darboux_io::words::Count;
use darboux_render::Model;

use super::shared::View;
use crate::commands::bake::arguments::BakeArguments;
use crate::documents::load_with_warnings;
use crate::html_page::drawing::{complete, draw as draw_model, open_adapter};
use crate::net;

/// The width and height of a picture.
const SIZE: [u32; 2] = [512, 384];

/// The sides, in words, with the degrees around the models and above the horizon.
const SIDES: [(&str, [f64; 2]); 4] = [
    ("front left", [30.0, 20.0]),
    ("front right", [-60.0, 20.0]),
    ("back right", [210.0, 20.0]),
    ("back left", [120.0, 20.0]),
];

/// The most triangles of high models that are drawn: each takes 600 bytes.
const MOST_TRIANGLES: u64 = 1_000_000;

/// Draws the high models and the low one. `low`: with its maps. Errors: a clause why there are no pictures.
pub fn draw(arguments: &BakeArguments, low: &Document, high_triangles: u64) -> Result<Vec<View>, String> {
    if high_triangles > MOST_TRIANGLES {
        return Err(format!(
            "the high models have {} triangles, and at most {} are drawn",
            Count(high_triangles),
            Count(MOST_TRIANGLES)
        ));
    }
    let gpu = open_adapter()?;
    net::catch(&arguments.low.display(), || draw_sides(arguments, &gpu, low))
}

fn draw_sides(arguments: &BakeArguments, gpu: &Gpu, low: &Document) -> Result<Vec<View>, String> {
    let sentence = |error: darboux_io::Error| error.to_string();
    let mut documents = Vec::new();
    for path in &arguments.high {
        let mut document = load_with_warnings(path, &arguments.reading, &mut Vec::new())?;
        complete(&mut document).map_err(sentence)?;
        documents.push(document);
    }
    let models = documents.iter().map(Model::read).collect::<Result<Vec<_>, _>>().map_err(sentence)?;
    let high = models.into_iter().reduce(Model::joined_with).ok_or("there is no high model")?;
    let low = Model::read(low).map_err(sentence)?;
    let view = |(side, camera)| {
        let picture = |model| draw_model(gpu, model, &high, camera, SIZE);
        Ok(View { side, high: picture(&high)?, low: picture(&low)? })
    };
    SIDES.into_iter().map(view).collect()
}
