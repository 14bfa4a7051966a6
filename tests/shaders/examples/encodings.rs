//! Draws docs/encodings.png: a plate for each encoding, drawn by the CPU in the upper row and by a GPU in the
//! lower row.

use std::fs::File;
use std::io::BufWriter;
use std::path::Path;

use darboux_shader_tests::gpus;
use darboux_shader_tests::picture::{Encoding, Plate, SIDE, draw_on_cpu, draw_on_gpu};

const GAP: usize = 4;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let gpu = gpus().first().ok_or("there is no GPU to draw with")?;
    let rows: [Vec<Plate>; 2] = [
        Encoding::ALL.map(draw_on_cpu).into(),
        Encoding::ALL.map(|encoding| draw_on_gpu(gpu, encoding)).into(),
    ];
    let (width, height) = (Encoding::ALL.len() * (SIDE + GAP) - GAP, rows.len() * (SIDE + GAP) - GAP);
    let mut pixels = vec![[0; 4]; width * height];
    for (down, plates) in rows.iter().enumerate() {
        for (right, plate) in plates.iter().enumerate() {
            for (line, row) in plate.chunks(SIDE).enumerate() {
                let start = (down * (SIDE + GAP) + line) * width + right * (SIDE + GAP);
                pixels[start..start + SIDE].copy_from_slice(row);
            }
        }
    }
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/encodings.png");
    let mut encoder = png::Encoder::new(BufWriter::new(File::create(path)?), width as u32, height as u32);
    encoder.set_color(png::ColorType::Rgba);
    encoder.set_compression(png::Compression::High);
    encoder.write_header()?.write_image_data(&pixels.concat())?;
    Ok(())
}
