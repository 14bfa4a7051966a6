//! A quad with a normal map as a GLB file, and functions that draw it.

use std::io::{Cursor, Write};
use std::sync::OnceLock;

use darboux_gpu::Gpu;
use darboux_io::LoadOptions;
use darboux_io::gltf::Document;
use darboux_render::{Camera, HeatScale, Mistakes, Model, Picture, RenderOptions, Side, View};

pub const BACKGROUND: [u8; 3] = [10, 20, 30];

/// A quad from -1 to 1 that faces the camera. It has a left and a right half, of two triangles each.
#[derive(Clone)]
pub struct Quad {
    pub half_size: f32,
    /// Whether u grows from the middle to both sides. Otherwise it grows from left to right.
    pub is_mirrored: bool,
    pub u_scale: f32,
    pub has_tangents: bool,
    /// The tangent of the right half. The left half has the same, with x negated if the UVs are mirrored.
    pub tangent: [f32; 3],
    /// The sign w of the left and the right half.
    pub w: [f32; 2],
    /// The colour of all texels of the normal map.
    pub texel: [u8; 3],
    /// The number of triangles, at most 4. The others have positions that are not finite.
    pub triangle_count: usize,
    /// JSON members of node 0.
    pub node: &'static str,
    /// JSON of more nodes, each after a comma.
    pub nodes: &'static str,
    /// JSON of more attributes, each after a comma. The accessors 0 to 3 have positions, normals, tangents
    /// and UVs.
    pub attributes: &'static str,
    /// JSON of more members of the primitive and of the file, each after a comma.
    pub primitive: &'static str,
    pub file: &'static str,
    /// JSON of more members of the material, each after a comma.
    pub material: &'static str,
    /// The file of the base colour texture and its media type. Without one the base colour is grey.
    pub base: Option<(Vec<u8>, &'static str)>,
    /// JSON of more members of the base colour texture, each after a comma. Sampler 0 clamps and magnifies
    /// to the nearest texel.
    pub base_sampler: &'static str,
    /// The extension that names the image of the base colour texture; empty if the texture itself names it.
    pub image_extension: &'static str,
}

impl Default for Quad {
    fn default() -> Self {
        Self {
            half_size: 1.0,
            is_mirrored: false,
            u_scale: 1.0,
            has_tangents: true,
            tangent: [1.0, 0.0, 0.0],
            w: [1.0; 2],
            texel: [128, 128, 255],
            triangle_count: 4,
            node: r#""translation":[5,0,0]"#,
            nodes: "",
            attributes: "",
            primitive: "",
            file: "",
            material: "",
            base: None,
            base_sampler: r#","sampler":0"#,
            image_extension: "",
        }
    }
}

impl Quad {
    /// A quad whose left half is mirrored.
    pub fn mirrored() -> Self {
        Self { is_mirrored: true, w: [-1.0, 1.0], ..Self::default() }
    }

    /// The arrays of positions, normals, tangents and UVs of all corners, concatenated.
    fn floats(&self) -> Vec<f32> {
        let (mut positions, mut tangents, mut uvs) = (Vec::new(), Vec::new(), Vec::new());
        for (side, from, to) in [(0, -1.0, 0.0), (1, 0.0, 1.0)] {
            let corners: [[f32; 2]; 6] =
                [[from, -1.0], [to, -1.0], [to, 1.0], [from, -1.0], [to, 1.0], [from, 1.0]];
            for [x, y] in corners {
                let is_drawn = positions.len() < 9 * self.triangle_count;
                let half_size = if is_drawn { self.half_size } else { f32::NAN };
                positions.extend([x * half_size, y * half_size, 0.0]);
                let [tx, ty, tz] = self.tangent;
                let tx = if self.is_mirrored && side == 0 { -tx } else { tx };
                tangents.extend([tx, ty, tz, self.w[side]]);
                let u = if self.is_mirrored { x.abs() } else { 0.5 + 0.5 * x };
                uvs.extend([u * self.u_scale, 0.5 - 0.5 * y]);
            }
        }
        let normals = [0.0, 0.0, 1.0].repeat(12);
        [positions, normals, tangents, uvs].concat()
    }

    fn glb(&self) -> Vec<u8> {
        let map = image::RgbImage::from_pixel(4, 4, image::Rgb(self.texel));
        let png = file_of(&map.into(), image::ImageFormat::Png);
        let mut bytes: Vec<u8> = self.floats().iter().flat_map(|x| x.to_le_bytes()).collect();
        let (floats, image) = (bytes.len(), png.len());
        bytes.extend(png);
        let (base, kind) = self.base.as_ref().map_or((&[][..], "image/png"), |(base, kind)| (base, kind));
        let base_at = bytes.len();
        bytes.extend(base);
        let base_texture = if base.is_empty() { "" } else { r#","baseColorTexture":{"index":1}"# };
        let base_source = match self.image_extension {
            "" => r#""source":1"#.to_owned(),
            extension => format!(r#""extensions":{{"{extension}":{{"source":1}}}}"#),
        };
        // Empty buffer views are invalid.
        let base_len = base.len().max(1);
        bytes.resize((bytes.len() + 1).next_multiple_of(4), 0);
        let accessor = |offset: usize, kind: &str| {
            format!(
                r#"{{"bufferView":0,"byteOffset":{offset},"componentType":5126,"count":12,"type":"{kind}"}}"#
            )
        };
        let accessors =
            [accessor(0, "VEC3"), accessor(144, "VEC3"), accessor(288, "VEC4"), accessor(480, "VEC2")];
        let tangents = if self.has_tangents { r#","TANGENT":2"# } else { "" };
        let json = format!(
            r#"{{"asset":{{"version":"2.0"}},"scenes":[{{"nodes":[0]}}],"nodes":[{{"mesh":0,{node}}}{nodes}]{file},
            "meshes":[{{"primitives":[{{"attributes":{{"POSITION":0,"NORMAL":1,"TEXCOORD_0":3{tangents}{attributes}}},"material":0{primitive}}}]}}],
            "materials":[{{"normalTexture":{{"index":0}},"pbrMetallicRoughness":{{"metallicFactor":0,"baseColorFactor":{factor}{base_texture}}}{material}}}],
            "textures":[{{"source":0}},{{{base_source}{sampler}}}],"samplers":[{{"magFilter":9728,"wrapS":33071,"wrapT":33071}}],
            "images":[{{"bufferView":1,"mimeType":"image/png"}},{{"bufferView":2,"mimeType":"{kind}"}}],
            "accessors":[{accessors}],
            "bufferViews":[{{"buffer":0,"byteLength":{floats}}},{{"buffer":0,"byteOffset":{floats},"byteLength":{image}}},
            {{"buffer":0,"byteOffset":{base_at},"byteLength":{base_len}}}],
            "buffers":[{{"byteLength":{length}}}]}}"#,
            node = self.node,
            nodes = self.nodes,
            attributes = self.attributes,
            primitive = self.primitive,
            file = self.file,
            material = self.material,
            sampler = self.base_sampler,
            factor = if base.is_empty() { "[0.5,0.5,0.5,1]" } else { "[1,1,1,1]" },
            accessors = accessors.join(","),
            length = bytes.len(),
        );
        let mut json = json.into_bytes();
        json.resize(json.len().next_multiple_of(4), b' ');
        let length = 12 + 8 + json.len() + 8 + bytes.len();
        let words = |words: [u32; 2]| words.map(u32::to_le_bytes).concat();
        [
            b"glTF".to_vec(),
            words([2, length as u32]),
            words([json.len() as u32, u32::from_le_bytes(*b"JSON")]),
            json,
            words([bytes.len() as u32, u32::from_le_bytes(*b"BIN\0")]),
            bytes,
        ]
        .concat()
    }
}

/// An image as a file.
pub fn file_of(image: &image::DynamicImage, format: image::ImageFormat) -> Vec<u8> {
    let mut file = Vec::new();
    image.write_to(&mut Cursor::new(&mut file), format).expect("an image");
    file
}

pub fn document(quad: &Quad) -> Document {
    load(quad).expect("a document")
}

/// Loads the file of a quad. Errors: invalid references.
pub fn load(quad: &Quad) -> Result<Document, darboux_io::Error> {
    Document::from_bytes("quad", quad.glb(), None, &LoadOptions::default())
}

/// The adapter that wgpu prefers, opened once; none if there is no adapter.
pub fn gpu() -> Option<&'static Gpu> {
    static GPU: OnceLock<Option<Gpu>> = OnceLock::new();
    GPU.get_or_init(|| pollster::block_on(Gpu::open()).ok()).as_ref()
}

/// Whether there is an adapter. If there is none, prints that the test is skipped.
pub fn has_adapter_or_says_so() -> bool {
    if gpu().is_none() {
        assert!(std::env::var_os("CI").is_none(), "no adapter");
        writeln!(std::io::stdout(), "skipped: no adapter (Debian: mesa-vulkan-drivers, libvulkan1)")
            .expect("standard output");
    }
    gpu().is_some()
}

pub fn heat() -> HeatScale {
    let ramp = [0, 1, 2, 3, 4, 5, 6, 7, 8].map(|step| [20 * step, 10, 255 - 20 * step]);
    HeatScale { ends: [0.01, 180.0], ramp, flip: [255, 0, 0], none: [0; 3] }
}

/// Options for a view from the front.
pub fn options(view: View) -> RenderOptions {
    RenderOptions::new(view, [64, 64], heat())
        .with_camera(Camera { yaw: 0.0, pitch: 0.0, zoom: 1.0 })
        .with_background(BACKGROUND)
}

/// Draws a model. Panics without an adapter.
pub fn shown(model: &Model<'_>, mistakes: Mistakes, options: &RenderOptions) -> Picture {
    let gpu = gpu().expect("an adapter");
    darboux_render::render(gpu, Side { model, mistakes }, None, options).unwrap_or_else(|e| panic!("{e}"))
}

/// Draws a quad. Panics without an adapter.
pub fn drawn(quad: &Quad, options: &RenderOptions) -> Picture {
    drawn_wrong(quad, Mistakes::default(), options)
}

/// Draws a quad with mistakes. Panics without an adapter.
pub fn drawn_wrong(quad: &Quad, mistakes: Mistakes, options: &RenderOptions) -> Picture {
    let document = document(quad);
    shown(&Model::read(&document).expect("a model"), mistakes, options)
}
