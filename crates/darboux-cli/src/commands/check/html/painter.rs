//! Draws a model as it is in its file and as `--fix` repairs it, from the side on which they differ most.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use darboux::{NormalOptions, Shading};
use darboux_check::{FixOptions, check_document, fix_document};
use darboux_gpu::Gpu;
use darboux_io::gltf::{AddNormalsOptions, AddTangentsOptions, Document, add_normals, add_tangents};
use darboux_io::image::PngImage;
use darboux_render::{Camera, HeatScale, Mistakes, Model, RenderOptions, Side, View, render};

use super::super::checks::Checks;
use super::pictures::{Pair, Pictures};
use crate::commands::render::no_adapter;
use crate::documents::load;
use crate::gpu::without_driver_messages;
use crate::heat_scale::{ENDS, FLIP, RAMP};
use crate::inputs::Input;
use crate::net;

/// The width and height of a picture in the page.
const SIZE: [u32; 2] = [640, 480];
/// How many pixels of the whole picture are one of its reduced copy. The close picture has the whole one's pixels.
const REDUCTION: u32 = 3;
/// The size of the pictures among which the camera is chosen.
const TRIAL: [u32; 2] = [240, 180];
/// The cameras among which one is chosen: degrees around the model and above the horizon.
const CAMERAS: [[f64; 2]; 8] = [
    [30.0, 20.0],
    [75.0, 20.0],
    [120.0, 20.0],
    [165.0, 20.0],
    [-60.0, 20.0],
    [-15.0, 20.0],
    [30.0, 70.0],
    [30.0, -60.0],
];
/// The difference of a channel, of 255, that is seen.
const SEEN: u8 = 14;
/// The least number of pixels of a small picture that are a difference and not noise.
const LEAST: usize = 3;
/// The side of the cells in which differing pixels are counted.
const CELL: u32 = 40;
const BACKGROUND: [u8; 3] = [51, 55, 62];

/// Draws the models of a check.
pub struct Painter<'a> {
    checks: &'a Checks<'a>,
    /// The adapter, or why there is none.
    gpu: Result<Gpu, String>,
}

impl<'a> Painter<'a> {
    /// Opens an adapter.
    pub fn open(checks: &'a Checks<'a>) -> Self {
        let gpu = without_driver_messages(|| pollster::block_on(Gpu::open())).map_err(no_adapter);
        Self { checks, gpu }
    }

    /// Draws a model.
    pub fn draw(&self, input: &Input) -> Pictures {
        let drawn = match &self.gpu {
            Ok(gpu) => net::catch(input, || self.try_draw(gpu, input)),
            Err(sentence) => Err(sentence.clone()),
        };
        drawn.unwrap_or_else(|sentence| Pictures::None(Some(format!("There is no picture: {sentence}."))))
    }

    fn try_draw(&self, gpu: &Gpu, input: &Input) -> Result<Pictures, String> {
        let sentence = |error: darboux_io::Error| error.to_string();
        let mut original = load(input, &self.checks.reading)?;
        let mut repaired = load(input, &self.checks.reading)?;
        let options = self.checks.findings.check_options();
        let findings = check_document(&repaired, &options).map_err(sentence)?;
        let findings =
            findings.into_iter().filter(|finding| self.checks.findings.reports(finding.code)).collect();
        let fixing = FixOptions::default().with_check(options);
        let is_changed = fix_document(&mut repaired, findings, &fixing).map_err(sentence)?.is_changed;
        complete(&mut original).map_err(sentence)?;
        let before = Model::read(&original).map_err(sentence)?;
        if !is_changed {
            let picture = Raster::draw(gpu, &before, CAMERAS[0], SIZE)?;
            let why = "The model as it is in the file. Nothing that was found is repaired without guessing, so there is no second picture.";
            return picture.png().map(|png| Pictures::One { png, size: SIZE, why: why.to_owned() });
        }
        complete(&mut repaired).map_err(sentence)?;
        let after = Model::read(&repaired).map_err(sentence)?;
        pairs(gpu, &before, &after)
    }
}

/// Adds the normals and tangents that are missing, as renderers do.
fn complete(document: &mut Document) -> Result<(), darboux_io::Error> {
    let flat = NormalOptions::new().with_shading(Shading::Flat);
    add_normals(document, &AddNormalsOptions::default().with_normals(flat), &mut |_| {})?;
    add_tangents(document, &AddTangentsOptions::default(), &mut |_| {})?;
    Ok(())
}

/// Draws both models from the camera with the largest difference: whole, and where they differ most.
fn pairs(gpu: &Gpu, before: &Model<'_>, after: &Model<'_>) -> Result<Pictures, String> {
    let mut best = (0, CAMERAS[0]);
    for camera in CAMERAS {
        let [a, b] = both(gpu, before, after, camera, TRIAL)?;
        let differing = a.differing(&b).count();
        if differing > best.0 {
            best = (differing, camera);
        }
    }
    let (differing, camera) = best;
    if differing < LEAST {
        let picture = Raster::draw(gpu, before, camera, SIZE)?;
        let why = format!(
            "The file and the repaired file look alike from {} sides in this light: the repair changes numbers, not this picture.",
            CAMERAS.len()
        );
        return picture.png().map(|png| Pictures::One { png, size: SIZE, why });
    }
    let [a, b] = both(gpu, before, after, camera, SIZE.map(|side| REDUCTION * side))?;
    let share = 100.0 * a.differing(&b).count() as f64 / a.pixels.len() as f64;
    let corner = a.worst_window(&b);
    let close = [&a, &b].map(|raster| raster.window(corner));
    let whole = [a, b].map(|raster| raster.reduced());
    let share = format!("The whole model; {share:.1} % of the pixels differ visibly");
    let closer = format!("{REDUCTION} times closer, where they differ most");
    Ok(Pictures::Pairs(vec![pair(closer, &close)?, pair(share, &whole)?]))
}

/// Both pictures, with the slider where they differ.
fn pair(caption: String, [before, after]: &[Raster; 2]) -> Result<Pair, String> {
    let middle = f64::from(before.middle_of_difference(after)[0]);
    let split = (100.0 * middle / f64::from(SIZE[0])).round().clamp(10.0, 90.0) as u32;
    Ok(Pair { caption, before: before.png()?, after: after.png()?, size: SIZE, split })
}

/// The same view of both models.
fn both(
    gpu: &Gpu,
    before: &Model<'_>,
    after: &Model<'_>,
    camera: [f64; 2],
    size: [u32; 2],
) -> Result<[Raster; 2], String> {
    Ok([Raster::draw(gpu, before, camera, size)?, Raster::draw(gpu, after, camera, size)?])
}

/// Pixels, row by row.
struct Raster {
    size: [u32; 2],
    pixels: Vec<[u8; 3]>,
}

impl Raster {
    fn draw(gpu: &Gpu, model: &Model<'_>, [yaw, pitch]: [f64; 2], size: [u32; 2]) -> Result<Self, String> {
        let heat = HeatScale { ends: ENDS.map(|end| end as f32), ramp: RAMP, flip: FLIP, none: [0; 3] };
        let options = RenderOptions::new(View::Shaded, size, heat)
            .with_camera(Camera { yaw, pitch, zoom: 1.0 })
            .with_background(BACKGROUND);
        let side = Side { model, mistakes: Mistakes::default() };
        let picture = render(gpu, side, None, &options).map_err(|error| error.to_string())?;
        Ok(Self { size, pixels: picture.pixels })
    }

    /// The numbers of the pixels that differ visibly from another picture's.
    fn differing(&self, other: &Self) -> impl Iterator<Item = usize> {
        let pairs = self.pixels.iter().zip(&other.pixels).enumerate();
        pairs.filter(|(_, (a, b))| (0..3).any(|i| a[i].abs_diff(b[i]) > SEEN)).map(|(number, _)| number)
    }

    /// The corner of the window of [`SIZE`] with the most pixels that differ.
    fn worst_window(&self, other: &Self) -> [u32; 2] {
        let [across, down] = self.size.map(|side| (side / CELL) as usize);
        let mut cells = vec![0usize; across * down];
        for number in self.differing(other) {
            let [x, y] = [number as u32 % self.size[0], number as u32 / self.size[0]].map(|at| at / CELL);
            cells[y as usize * across + x as usize] += 1;
        }
        let [wide, high] = SIZE.map(|side| (side / CELL) as usize);
        let sum = |x: usize, y: usize| -> usize {
            (y..y + high).map(|row| cells[row * across + x..][..wide].iter().sum::<usize>()).sum()
        };
        let corners = (0..=down - high).flat_map(|y| (0..=across - wide).map(move |x| (x, y)));
        let (x, y) = corners.max_by_key(|&(x, y)| sum(x, y)).unwrap_or_default();
        let corner = [x, y].map(|cell| cell as u32 * CELL);
        let middle = self.window(corner).middle_of_difference(&other.window(corner));
        [0, 1].map(|i| (corner[i] + middle[i]).saturating_sub(SIZE[i] / 2).min(self.size[i] - SIZE[i]))
    }

    /// The mean place of the pixels that differ; the middle of the picture where none does.
    fn middle_of_difference(&self, other: &Self) -> [u32; 2] {
        let width = u64::from(self.size[0]);
        let (mut sums, mut count) = ([0u64; 2], 0u64);
        for number in self.differing(other) {
            sums[0] += number as u64 % width;
            sums[1] += number as u64 / width;
            count += 1;
        }
        if count == 0 { self.size.map(|side| side / 2) } else { sums.map(|sum| (sum / count) as u32) }
    }

    /// A part of [`SIZE`].
    fn window(&self, [left, top]: [u32; 2]) -> Self {
        let [width, height] = SIZE;
        let row = |y: u32| {
            let start = ((top + y) * self.size[0] + left) as usize;
            &self.pixels[start..start + width as usize]
        };
        Self { size: SIZE, pixels: (0..height).flat_map(|y| row(y).to_vec()).collect() }
    }

    /// The mean colours of squares of [`REDUCTION`] pixels.
    fn reduced(&self) -> Self {
        let [width, height] = self.size.map(|side| side / REDUCTION);
        let mean = |x: u32, y: u32, channel: usize| {
            let in_square = (0..REDUCTION * REDUCTION).map(|at| {
                let [dx, dy] = [at % REDUCTION, at / REDUCTION];
                let number = (REDUCTION * y + dy) * self.size[0] + REDUCTION * x + dx;
                u32::from(self.pixels[number as usize][channel])
            });
            (in_square.sum::<u32>() / (REDUCTION * REDUCTION)) as u8
        };
        let pixels = (0..height).flat_map(|y| (0..width).map(move |x| [x, y]));
        let pixels = pixels.map(|[x, y]| [0, 1, 2].map(|channel| mean(x, y, channel))).collect();
        Self { size: [width, height], pixels }
    }

    /// The address that holds the picture as a PNG.
    fn png(&self) -> Result<String, String> {
        let image = PngImage::from_rgb("the picture", self.size, &self.pixels);
        let bytes = image.and_then(|image| image.to_bytes()).map_err(|error| error.to_string())?;
        Ok(format!("data:image/png;base64,{}", STANDARD.encode(bytes)))
    }
}
