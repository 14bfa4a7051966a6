//! Generates normal maps whose convention is known, as tools make them and files store them.

pub mod calibration;
pub mod damage;
pub mod outcome;
pub mod page;
pub mod surfaces;
pub mod table;
pub mod truth;

use crate::Dice;
use damage::{Storage, Texel};
use surfaces::Surface;

/// What lies between the charts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Background {
    /// The flat colour.
    Flat,
    /// Black.
    Black,
    /// Middle grey.
    Grey,
    /// Nothing: every chart reaches to the next one.
    Padded,
}

/// How slopes come from heights.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Difference {
    /// Left and right neighbour, as filters of image programs.
    Central,
    /// The texel and its next neighbour.
    Forward,
    /// The slope at the middle of the texel, as a baker samples it.
    Point,
    /// The mean of the slopes over the texel, along two lines.
    Supersampled,
}

/// A normal map to generate.
#[derive(Clone, Debug)]
pub struct MapCase {
    /// What the map shows.
    pub surface: Surface,
    /// Texels per row and column, a multiple of 16.
    pub side: usize,
    /// Texels per feature.
    pub feature: f32,
    /// The amplitude of octaves.
    pub gain: f32,
    /// The root of the mean squared slope.
    pub slope: f32,
    /// Charts with transforms of their own; 1 is the whole map.
    pub charts: usize,
    /// Texels of u per texel of v at the same length on the surface.
    pub stretch: f32,
    /// What lies between charts.
    pub background: Background,
    /// How slopes are made.
    pub difference: Difference,
    /// The deviation of added noise, in 1/255.
    pub noise: f32,
    /// How the map is stored.
    pub storage: Storage,
    seed: u64,
}

/// A rectangle of the map and where it lies on the surface.
struct Chart {
    x: std::ops::Range<usize>,
    y: std::ops::Range<usize>,
    /// Lengths on the surface per texel of u and v, and how far v leans along u.
    scale: [f32; 2],
    shear: f32,
    is_mirrored: bool,
    rotation: [f32; 2],
    origin: [f32; 2],
}

/// Of every 200 maps, how many have which side. The time per map grows with the square of the side.
pub const SHARES: [(usize, u64); 5] = [(256, 125), (512, 54), (1024, 16), (2048, 4), (4096, 1)];

/// The side of a numbered map. 37 has no factor in common with 200, so that the sides are spread over all
/// surfaces.
fn side_of(number: u64) -> usize {
    let mut place = number * 37 % 200;
    let found = SHARES.iter().find(|(_, share)| {
        let is_here = place < *share;
        place = place.saturating_sub(*share);
        is_here
    });
    found.map_or(256, |(side, _)| *side)
}

/// The slopes of a generated map, before it is stored.
pub struct Relief<'a> {
    case: &'a MapCase,
    /// The slopes along u and (upwards) v of every texel; none outside all charts.
    slopes: Vec<Option<[f32; 2]>>,
}

impl MapCase {
    /// The case of a number. Sides are at most `largest_side`.
    pub fn new(seed: u64, largest_side: usize) -> Self {
        let mut dice = Dice::from_seed(seed);
        let mut unit = || (Dice::uniform(&mut dice) + 1.0) / 2.0;
        let side = side_of(seed).min(largest_side);
        let mut between = |low: f32, high: f32| low * (high / low).powf(unit());
        let feature = between(12.0, side as f32 / 4.0);
        let slope = between(0.03, 0.9);
        let gain = between(0.3, 0.9);
        let stretch = between(1.0 / 8.0, 8.0);
        let quality = between(60.0, 96.0) as u32;
        let storages = [
            Storage::Rounded,
            Storage::Rounded,
            Storage::ChannelBlocks,
            Storage::ColorBlocks,
            Storage::Jpeg { quality, halves_colors: false },
            Storage::Jpeg { quality, halves_colors: true },
        ];
        Self {
            surface: Surface::ALL[seed as usize % Surface::ALL.len()],
            side,
            feature,
            gain,
            slope,
            charts: if dice.one_in(2) { 1 } else { 2 + dice.below(40) },
            stretch: if dice.one_in(2) { 1.0 } else { stretch },
            background: dice.pick(&[
                Background::Flat,
                Background::Black,
                Background::Grey,
                Background::Padded,
            ]),
            difference: dice.pick(&[
                Difference::Central,
                Difference::Forward,
                Difference::Point,
                Difference::Supersampled,
            ]),
            noise: dice.pick(&[0.0, 0.0, 0.5, 1.0, 2.0]),
            storage: dice.pick(&storages),
            seed,
        }
    }

    /// The slopes of the map, scaled to [`Self::slope`].
    pub fn relief(&self) -> Relief<'_> {
        let mut dice = Dice::from_seed(self.seed ^ 0x5bd1_e995);
        let mut slopes = self.slopes(&mut dice);
        let (sum, count) = slopes
            .iter()
            .flatten()
            .fold((0.0f64, 0usize), |(sum, count), [p, q]| (sum + f64::from(p * p + q * q) / 2.0, count + 1));
        let strength = self.slope / ((sum / count.max(1) as f64).sqrt() as f32).max(1e-12);
        slopes.iter_mut().flatten().flatten().for_each(|slope| *slope *= strength);
        Relief { case: self, slopes }
    }

    /// The texels, the top row first; green points up (OpenGL), or down with `flips_green`.
    pub fn texels(&self, flips_green: bool) -> Vec<[u8; 3]> {
        self.relief().texels(flips_green)
    }

    /// The slopes along u and (upwards) v of every texel; none outside all charts.
    fn slopes(&self, dice: &mut Dice<'_>) -> Vec<Option<[f32; 2]>> {
        let charts = self.charts(dice);
        let mut slopes = vec![None; self.side * self.side];
        for chart in &charts {
            let heights = Heights::new(self, chart);
            for y in chart.y.clone() {
                for x in chart.x.clone() {
                    let [along_u, along_v] = heights.differences(x, y);
                    let p = along_u / chart.scale[0];
                    slopes[y * self.side + x] = Some([p, (along_v - chart.shear * p) / chart.scale[1]]);
                }
            }
        }
        slopes
    }

    /// The height at a texel; rows count downwards, v upwards.
    fn height(&self, chart: &Chart, x: f32, y: f32) -> f32 {
        let (u, v) = (x, -y);
        let along = [u * chart.scale[0] + v * chart.shear, v * chart.scale[1]];
        let along = [if chart.is_mirrored { -along[0] } else { along[0] }, along[1]];
        let [cos, sin] = chart.rotation;
        let at = [along[0] * cos - along[1] * sin, along[0] * sin + along[1] * cos];
        let at = [0, 1].map(|i| at[i] / self.feature + chart.origin[i]);
        self.surface.height(self.seed as u32, self.gain, at)
    }

    /// Rectangles that fill the map, with gaps unless the map is padded.
    fn charts(&self, dice: &mut Dice<'_>) -> Vec<Chart> {
        let mut rectangles = vec![[0, 0, self.side, self.side]];
        while rectangles.len() < self.charts {
            let area = |r: &[usize; 4]| (r[2] - r[0]) * (r[3] - r[1]);
            let largest = (0..rectangles.len()).max_by_key(|&i| area(&rectangles[i])).unwrap_or(0);
            let [left, top, right, bottom] = rectangles.swap_remove(largest);
            let part = 0.3 + 0.2 * (dice.uniform() + 1.0);
            let cut = |low: usize, high: usize| low + ((high - low) as f32 * part) as usize;
            if right - left > bottom - top {
                let middle = cut(left, right);
                rectangles.extend([[left, top, middle, bottom], [middle, top, right, bottom]]);
            } else {
                let middle = cut(top, bottom);
                rectangles.extend([[left, top, right, middle], [left, middle, right, bottom]]);
            }
        }
        let is_whole = self.charts == 1;
        let gap = if is_whole || self.background == Background::Padded { 0 } else { 1 + dice.below(8) };
        let chart = |[left, top, right, bottom]: [usize; 4]| {
            self.chart(dice, [left + gap, top + gap, right - gap, bottom - gap], is_whole)
        };
        rectangles.into_iter().map(chart).collect()
    }

    fn chart(&self, dice: &mut Dice<'_>, [left, top, right, bottom]: [usize; 4], is_whole: bool) -> Chart {
        let angle = match (is_whole, dice.below(3)) {
            (true, 0 | 1) => 0.0,
            (_, 0) => std::f32::consts::FRAC_PI_2 * dice.below(4) as f32,
            _ => 3.2 * dice.uniform(),
        };
        let stretch = self.stretch.sqrt();
        let shear = if is_whole || !dice.one_in(4) { 0.0 } else { 0.5 * dice.uniform() / stretch };
        Chart {
            x: left..right,
            y: top..bottom,
            scale: [stretch, 1.0 / stretch],
            shear,
            is_mirrored: dice.one_in(2),
            rotation: [angle.cos(), angle.sin()],
            origin: [0, 1].map(|_| 100.0 + 50.0 * dice.uniform()),
        }
    }
}

/// The heights of a chart.
struct Heights<'a> {
    case: &'a MapCase,
    chart: &'a Chart,
    /// The heights at the middles of the texels of the chart and of one texel around it; empty where
    /// differences are finer.
    middles: Vec<f32>,
}

impl<'a> Heights<'a> {
    fn new(case: &'a MapCase, chart: &'a Chart) -> Self {
        let is_coarse = matches!(case.difference, Difference::Central | Difference::Forward);
        let [columns, rows] = [&chart.x, &chart.y].map(|range| range.len() + 2);
        let height = |i: usize| {
            let [x, y] = [chart.x.start + i % columns, chart.y.start + i / columns];
            case.height(chart, x as f32 - 0.5, y as f32 - 0.5)
        };
        let middles = (0..if is_coarse { columns * rows } else { 0 }).map(height).collect();
        Self { case, chart, middles }
    }

    /// The differences of the height per texel along u and (upwards) v.
    fn differences(&self, x: usize, y: usize) -> [f32; 2] {
        let columns = self.chart.x.len() + 2;
        let middle = |dx: usize, dy: usize| {
            self.middles[(y - self.chart.y.start + dy) * columns + x - self.chart.x.start + dx]
        };
        let at = |dx: f32, dy: f32| self.case.height(self.chart, x as f32 + 0.5 + dx, y as f32 + 0.5 + dy);
        match self.case.difference {
            Difference::Central => [(middle(2, 1) - middle(0, 1)) / 2.0, (middle(1, 0) - middle(1, 2)) / 2.0],
            Difference::Forward => [middle(2, 1) - middle(1, 1), middle(1, 0) - middle(1, 1)],
            Difference::Point => [(at(0.1, 0.0) - at(-0.1, 0.0)) / 0.2, (at(0.0, -0.1) - at(0.0, 0.1)) / 0.2],
            Difference::Supersampled => {
                let mean = |difference: &dyn Fn(f32) -> f32| (difference(-0.25) + difference(0.25)) / 2.0;
                [mean(&|d| at(0.5, d) - at(-0.5, d)), mean(&|d| at(d, -0.5) - at(d, 0.5))]
            }
        }
    }
}

impl Relief<'_> {
    /// The case that it was made for.
    pub fn case(&self) -> &MapCase {
        self.case
    }

    /// The texels, the top row first; green points up (OpenGL), or down with `flips_green`.
    pub fn texels(&self, flips_green: bool) -> Vec<[u8; 3]> {
        let case = self.case;
        let green = if flips_green { -1.0 } else { 1.0 };
        let background = match case.background {
            Background::Flat | Background::Padded => [127.5, 127.5, 255.0],
            Background::Black => [0.0; 3],
            Background::Grey => [127.5; 3],
        };
        let texel = |slope: &Option<[f32; 2]>| match slope {
            Some([p, q]) => {
                let length = (p * p + q * q + 1.0).sqrt();
                [-p, -q * green, 1.0].map(|x| (x / length + 1.0) * 127.5)
            }
            None => background,
        };
        let mut texels: Vec<Texel> = self.slopes.iter().map(texel).collect();
        if case.noise > 0.0 {
            let mut dice = Dice::from_seed(case.seed ^ 0x27d4_eb2f);
            damage::add_noise(&mut dice, case.noise, &mut texels);
        }
        case.storage.store([case.side; 2], texels)
    }
}
