//! Draws a waving flag. The GPU moves its vertices, and a plan computes their normals and tangents, all in
//! one command encoder.
//!
//! The UVs of its outer half mirror those of the inner half. The upper row uses the tangents of the plan, the
//! lower row those of the flag at rest.
//!
//! `cargo run -p darboux-gpu --example flag -- docs/flag.png`

#[path = "flag/picture.rs"]
mod picture;

use darboux::{Error, Mesh, TangentOptions, VertexSplit, generate_tangents, split_vertices};
use darboux_gpu::{Attribute, Gpu, MovingMesh, Planner, Precision, TangentsPer};
use picture::{HEIGHT, Painter, WIDTH};
use wgpu::util::{BufferInitDescriptor, DeviceExt};
use wgpu::{Buffer, BufferUsages};

/// The times of the pictures, from left to right.
const TIMES: [f32; 3] = [0.0, 1.7, 3.4];
/// The byte length of a vertex: position, normal, UV and tangent.
const STRIDE: u32 = 48;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let path = std::env::args().nth(1).unwrap_or_else(|| "flag.png".to_owned());
    let gpu = pollster::block_on(Gpu::open())?;
    let pixels = paint(&gpu)?;
    let mut encoder = png::Encoder::new(std::fs::File::create(&path)?, WIDTH, HEIGHT);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_compression(png::Compression::High);
    encoder.set_filter(png::Filter::Adaptive);
    // Six bits per channel halve the size of the file.
    let colors: Vec<u8> =
        pixels.as_chunks::<4>().0.iter().flat_map(|pixel| [0, 1, 2].map(|k| pixel[k] & 0xfc)).collect();
    encoder.write_header()?.write_image_data(&colors)?;
    println!("{path}: {WIDTH} by {HEIGHT}, on {}", gpu.name);
    Ok(())
}

/// Draws all times. Returns RGBA, row by row.
pub fn paint(gpu: &Gpu) -> Result<Vec<u8>, Box<dyn std::error::Error>> {
    let flag = Flag::new()?;
    let painter = Painter::new(gpu, flag.split.indices.as_slice());
    let at_rest = flag.upload(gpu);
    let plan = Planner::new(&gpu.device, Precision::Exact).plan(&flag.mesh()?, &TangentOptions::default())?;
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    for (column, time) in TIMES.into_iter().enumerate() {
        for row in 0..2 {
            let vertices = flag.vertices(gpu);
            painter.wave(&mut encoder, time, &at_rest, &vertices);
            let part = |offset| Attribute { buffer: &vertices, stride: STRIDE, offset };
            let moving = MovingMesh {
                vertex_count: flag.positions.len() as u32,
                positions: part(0),
                normals: part(12),
                tangents: part(32),
                per: TangentsPer::Vertex,
            };
            plan.bind_normals(&moving)?.record(&mut encoder);
            if row == 0 {
                plan.bind(&moving)?.record(&mut encoder);
            }
            painter.draw(&mut encoder, [column as u32, row], &vertices);
        }
    }
    Ok(painter.finish(encoder))
}

/// The flag at rest, with vertices split where tangents differ.
struct Flag {
    positions: Vec<[f32; 3]>,
    normals: Vec<[f32; 3]>,
    uvs: Vec<[f32; 2]>,
    split: VertexSplit,
}

/// The number of quads along the flag and up.
const SIZE: [usize; 2] = [72, 40];

impl Flag {
    fn new() -> Result<Self, Error> {
        let [columns, rows] = SIZE;
        let (mut positions, mut uvs, mut indices) = (Vec::new(), Vec::new(), Vec::new());
        for (row, column) in (0..=rows).flat_map(|row| (0..=columns).map(move |column| (row, column))) {
            let [x, y] = [3.0 * column as f32 / columns as f32, 2.0 * row as f32 / rows as f32];
            positions.push([x, y, 0.0]);
            uvs.push([(x - 1.5).abs() / 1.5, y / 2.0]);
            let at = (row * (columns + 1) + column) as u32;
            if row < rows && column < columns {
                let above = at + columns as u32 + 1;
                indices.extend([at, at + 1, above, at + 1, above + 1, above]);
            }
        }
        let normals = vec![[0.0, 0.0, 1.0]; positions.len()];
        let mesh = Mesh::triangles(&positions, &normals, &uvs, &indices)?;
        let tangents = generate_tangents(&mesh, &TangentOptions::default());
        let split = split_vertices(&mesh, &tangents.corners)?;
        let source = |v: &u32| *v as usize;
        Ok(Self {
            positions: split.source_of_vertex.iter().map(|v| positions[source(v)]).collect(),
            normals: split.source_of_vertex.iter().map(|v| normals[source(v)]).collect(),
            uvs: split.source_of_vertex.iter().map(|v| uvs[source(v)]).collect(),
            split,
        })
    }

    fn mesh(&self) -> Result<Mesh<'_>, Error> {
        Mesh::triangles(&self.positions, &self.normals, &self.uvs, &self.split.indices)
    }

    /// A buffer of the positions.
    fn upload(&self, gpu: &Gpu) -> Buffer {
        buffer(gpu, self.positions.as_flattened())
    }

    /// A buffer of the vertices, as they are drawn.
    fn vertices(&self, gpu: &Gpu) -> Buffer {
        let all = self.positions.iter().zip(&self.normals).zip(&self.uvs).zip(&self.split.tangent_of_vertex);
        let words = all.flat_map(|(((position, normal), uv), tangent)| {
            position.iter().chain(normal).chain(uv).chain(tangent).copied()
        });
        buffer(gpu, &words.collect::<Vec<f32>>())
    }
}

fn buffer(gpu: &Gpu, floats: &[f32]) -> Buffer {
    gpu.device.create_buffer_init(&BufferInitDescriptor {
        label: None,
        contents: bytemuck::cast_slice(floats),
        usage: BufferUsages::STORAGE | BufferUsages::VERTEX | BufferUsages::COPY_SRC,
    })
}
