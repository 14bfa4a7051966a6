//! Draws a model as it is in its file and as `--fix` repairs it, from the side on which they differ most.

use darboux_check::{FixOptions, check_document, fix_document};
use darboux_gpu::Gpu;
use darboux_render::Model;

use super::super::checks::Checks;
use super::pictures::{Pair, Pictures};
use crate::documents::load;
use crate::html_page::drawing::{complete, draw, open_adapter};
use crate::html_page::raster::Raster;
use crate::inputs::Input;
use crate::net;

/// The width and height of a picture in the page.
const SIZE: [u32; 2] = [640, 480];
/// How many pixels of the whole picture are one of its reduced copy. The close picture has the whole one's
/// pixels.
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

/// Draws the models of a check.
pub struct Painter<'a> {
    checks: &'a Checks<'a>,
    /// The adapter, or why there is none.
    gpu: Result<Gpu, String>,
}

impl<'a> Painter<'a> {
    /// Opens an adapter.
    pub fn open(checks: &'a Checks<'a>) -> Self {
        Self { checks, gpu: open_adapter() }
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
            let picture = draw(gpu, &before, &before, CAMERAS[0], SIZE)?;
            let why = "The model as it is in the file. Nothing that was found is repaired without guessing, \
                 so there is no second picture.";
            return picture.address().map(|png| Pictures::One { png, size: SIZE, why: why.to_owned() });
        }
        complete(&mut repaired).map_err(sentence)?;
        let after = Model::read(&repaired).map_err(sentence)?;
        pairs(gpu, &before, &after)
    }
}

/// Draws both models from the camera with the largest difference: whole, and where they differ most.
fn pairs(gpu: &Gpu, before: &Model<'_>, after: &Model<'_>) -> Result<Pictures, String> {
    let mut best = (0, CAMERAS[0]);
    for camera in CAMERAS {
        let [a, b] = both(gpu, before, after, camera, TRIAL)?;
        let count = differing(&a, &b).count();
        if count > best.0 {
            best = (count, camera);
        }
    }
    let (count, camera) = best;
    if count < LEAST {
        let picture = draw(gpu, before, before, camera, SIZE)?;
        let why = format!(
            "The file and the repaired file look alike from {} sides in this light: the repair changes \
             numbers, not this picture.",
            CAMERAS.len()
        );
        return picture.address().map(|png| Pictures::One { png, size: SIZE, why });
    }
    let [a, b] = both(gpu, before, after, camera, SIZE.map(|side| REDUCTION * side))?;
    let share = 100.0 * differing(&a, &b).count() as f64 / a.pixels.len() as f64;
    let corner = worst_window(&a, &b);
    let close = [&a, &b].map(|raster| window(raster, corner));
    let whole = [a, b].map(|raster| raster.reduced(REDUCTION));
    let share = format!("The whole model; {share:.1} % of the pixels differ visibly");
    let closer = format!("{REDUCTION} times closer, where they differ most");
    Ok(Pictures::Pairs(vec![pair(closer, &close)?, pair(share, &whole)?]))
}

/// Both pictures, with the slider where they differ.
fn pair(caption: String, [before, after]: &[Raster; 2]) -> Result<Pair, String> {
    let middle = f64::from(middle_of_difference(before, after)[0]);
    let split = (100.0 * middle / f64::from(SIZE[0])).round().clamp(10.0, 90.0) as u32;
    Ok(Pair { caption, before: before.address()?, after: after.address()?, size: SIZE, split })
}

/// The same view of both models.
fn both(
    gpu: &Gpu,
    before: &Model<'_>,
    after: &Model<'_>,
    camera: [f64; 2],
    size: [u32; 2],
) -> Result<[Raster; 2], String> {
    Ok([draw(gpu, before, before, camera, size)?, draw(gpu, after, after, camera, size)?])
}

/// The numbers of the pixels that differ visibly between two pictures.
fn differing(a: &Raster, b: &Raster) -> impl Iterator<Item = usize> {
    let pairs = a.pixels.iter().zip(&b.pixels).enumerate();
    pairs.filter(|(_, (a, b))| (0..3).any(|i| a[i].abs_diff(b[i]) > SEEN)).map(|(number, _)| number)
}

/// The corner of the window of [`SIZE`] with the most pixels that differ.
fn worst_window(a: &Raster, b: &Raster) -> [u32; 2] {
    let [across, down] = a.size.map(|side| (side / CELL) as usize);
    let mut cells = vec![0usize; across * down];
    for number in differing(a, b) {
        let [x, y] = [number as u32 % a.size[0], number as u32 / a.size[0]].map(|at| at / CELL);
        cells[y as usize * across + x as usize] += 1;
    }
    let [wide, high] = SIZE.map(|side| (side / CELL) as usize);
    let sum = |x: usize, y: usize| -> usize {
        (y..y + high).map(|row| cells[row * across + x..][..wide].iter().sum::<usize>()).sum()
    };
    let corners = (0..=down - high).flat_map(|y| (0..=across - wide).map(move |x| (x, y)));
    let (x, y) = corners.max_by_key(|&(x, y)| sum(x, y)).unwrap_or_default();
    let corner = [x, y].map(|cell| cell as u32 * CELL);
    let middle = middle_of_difference(&window(a, corner), &window(b, corner));
    [0, 1].map(|i| (corner[i] + middle[i]).saturating_sub(SIZE[i] / 2).min(a.size[i] - SIZE[i]))
}

/// The mean place of the pixels that differ; the middle of the picture where none does.
fn middle_of_difference(a: &Raster, b: &Raster) -> [u32; 2] {
    let width = u64::from(a.size[0]);
    let (mut sums, mut count) = ([0u64; 2], 0u64);
    for number in differing(a, b) {
        sums[0] += number as u64 % width;
        sums[1] += number as u64 / width;
        count += 1;
    }
    if count == 0 { a.size.map(|side| side / 2) } else { sums.map(|sum| (sum / count) as u32) }
}

/// A part of [`SIZE`].
fn window(raster: &Raster, [left, top]: [u32; 2]) -> Raster {
    let [width, height] = SIZE;
    let row = |y: u32| {
        let start = ((top + y) * raster.size[0] + left) as usize;
        &raster.pixels[start..start + width as usize]
    };
    Raster { size: SIZE, pixels: (0..height).flat_map(|y| row(y).to_vec()).collect() }
}
