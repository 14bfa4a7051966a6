//! The legend below a picture, which explains its colours, and the names of its two sides.

use std::convert::Infallible;

use darboux_render::{LINE_COLORS, LINE_DASHES, Picture, RenderOptions, SEAM_COLOR, SIGN_COLORS, View};
use embedded_graphics::mono_font::iso_8859_1::FONT_6X13;
use embedded_graphics::mono_font::{MonoFont, MonoTextStyle};
use embedded_graphics::pixelcolor::{Rgb888, RgbColor};
use embedded_graphics::prelude::{Dimensions, DrawTarget, Point, Size};
use embedded_graphics::primitives::Rectangle;
use embedded_graphics::text::{Baseline, Text};
use embedded_graphics::{Drawable, Pixel};

use super::arguments::{MistakeChoice, RenderArguments, ShaderMistake, TangentSource};
use crate::heat_scale::{row, scale_position};

const FONT: &MonoFont<'_> = &FONT_6X13;
const LETTER: u32 = FONT.character_size.width;
const LINE: u32 = FONT.character_size.height;

/// The space in pixels around and between the parts of the legend.
const GAP: u32 = 8;
/// The height of the colour scale and of the squares of colour, in pixels.
const BAR: u32 = 10;
/// The minimum width of the scale in pixels; its labels overlap in a narrower one.
const MIN_SCALE_WIDTH: u32 = 150;
/// A picture lower than this multiple of the legend gets no legend.
const MIN_HEIGHT_RATIO: u32 = 6;
/// The labels of the scale in degrees, the same as in the viewer.
const LABELS: [f64; 5] = [0.01, 0.1, 1.0, 10.0, 180.0];

/// The colour of mistakes in captions, on light and on dark paper.
const WRONG: [Rgb888; 2] = [Rgb888::new(168, 32, 13), Rgb888::new(255, 143, 125)];

/// A colour, the second sign beside it, and their meaning.
#[derive(Clone, Copy)]
struct Key {
    color: [u8; 3],
    sign: Sign,
    meaning: &'static str,
}

/// What distinguishes a colour from others without its hue.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Sign {
    Square,
    Stripes,
    /// A line of so many dashes.
    Dashes(u32),
}

const fn key(color: [u8; 3], meaning: &'static str) -> Key {
    Key { color, sign: Sign::Square, meaning }
}

/// The caption of a side: the source of its tangents, and the mistakes made with them; empty without one.
struct Caption {
    source: String,
    mistakes: String,
}

/// The legend of a picture.
pub struct Legend {
    keys: Vec<Key>,
    has_scale: bool,
    /// The captions of the left and the right side, and the position of the divide as a fraction of the
    /// width.
    sides: Option<([Caption; 2], f64)>,
    /// The mistakes made in an undivided picture; empty without one.
    mistakes: String,
    /// The height in pixels; 0 without a legend.
    rows: u32,
    ink: Rgb888,
    paper: [u8; 3],
}

impl Legend {
    /// The legend for these arguments. `source`: the source of the tangents on the left.
    pub fn of(arguments: &RenderArguments, source: TangentSource, options: &RenderOptions) -> Self {
        let mut keys = colors_of(options);
        let lines = &options.lines;
        let vectors = [(lines.tangent, "tangent"), (lines.bitangent, "bitangent"), (lines.normal, "normal")];
        let drawn = vectors.into_iter().zip(LINE_COLORS.into_iter().zip(LINE_DASHES));
        keys.extend(
            drawn.filter(|((is_drawn, _), _)| *is_drawn).map(|((_, meaning), (color, dashes))| Key {
                color,
                sign: Sign::Dashes(dashes),
                meaning,
            }),
        );
        let seams = Key { color: SEAM_COLOR, sign: Sign::Dashes(1), meaning: "mirrored seam" };
        keys.extend(options.seams.then_some(seams));
        let has_scale = options.view == View::Angle;
        let [width, height] = options.size;
        let needed = if has_scale { BAR + LINE + 2 * GAP } else { LINE + GAP };
        let needed = if keys.is_empty() { 0 } else { needed };
        let fits =
            !arguments.no_legend && height >= MIN_HEIGHT_RATIO * needed && width >= MIN_SCALE_WIDTH + 2 * GAP;
        let light: u32 = options.background.iter().map(|&channel| u32::from(channel)).sum();
        Self {
            keys,
            has_scale,
            sides: sides_of(arguments, source).filter(|_| fits),
            mistakes: if fits && arguments.split.is_none() { mistakes_of(arguments) } else { String::new() },
            rows: if fits { needed } else { 0 },
            ink: if light > 3 * 128 { Rgb888::BLACK } else { Rgb888::WHITE },
            paper: options.background,
        }
    }

    /// The options of the picture above the legend.
    pub fn above(&self, options: &RenderOptions) -> RenderOptions {
        let [width, height] = options.size;
        options.clone().with_size([width, height - self.rows])
    }

    /// Draws the legend into the picture.
    pub fn add(&self, picture: &mut Picture) {
        let [width, height] = picture.size;
        picture.size = [width, height + self.rows];
        picture.pixels.resize((width * (height + self.rows)) as usize, self.paper);
        let mut canvas = Canvas { width, pixels: &mut picture.pixels };
        if let Some(([left, right], part)) = &self.sides {
            let middle = (f64::from(width) * part).round() as u32;
            canvas.fill([middle, 0], [1, height], [self.ink.r(), self.ink.g(), self.ink.b()]);
            let from = middle.saturating_sub(GAP + LETTER * left.source.chars().count() as u32);
            self.write(&mut canvas, &left.source, [from, GAP]);
            self.write(&mut canvas, &right.source, [middle + GAP, GAP]);
            self.write_wrong(&mut canvas, &right.mistakes, [middle + GAP, GAP + LINE]);
        }
        self.write_wrong(&mut canvas, &self.mistakes, [GAP, GAP]);
        if self.rows == 0 {
            return;
        }
        let top = height + GAP / 2;
        let mut keys = self.keys.as_slice();
        let mut left = GAP;
        if self.has_scale {
            let mut available = width.saturating_sub(2 * GAP + widths(keys));
            if available < MIN_SCALE_WIDTH {
                (keys, available) = (&[], width - 2 * GAP);
            }
            self.scale(&mut canvas, [left, height + GAP], available);
            left += available + 2 * GAP;
        }
        for &Key { color, sign, meaning } in keys {
            let [square, text] = [[left, top + (LINE - BAR) / 2], [left + BAR + GAP / 2, top]];
            draw_sign(&mut canvas, sign, color, square);
            self.write(&mut canvas, meaning, text);
            left += key_width(meaning);
        }
    }

    /// Draws the scale of angles and its labels.
    fn scale(&self, canvas: &mut Canvas<'_>, [left, top]: [u32; 2], width: u32) {
        for (column, color) in (left..).zip(row(width as usize)) {
            canvas.fill([column, top], [1, BAR], color);
        }
        for degrees in LABELS {
            let label = format!("{degrees}°");
            let half = LETTER * label.chars().count() as u32 / 2;
            let at = (scale_position(degrees) * f64::from(width)) as u32;
            let from = left + at.max(half).min(width - half) - half;
            self.write(canvas, &label, [from, top + BAR + 2]);
        }
    }

    fn write(&self, canvas: &mut Canvas<'_>, text: &str, at: [u32; 2]) {
        Self::write_in(canvas, self.ink, text, at);
    }

    /// Writes mistakes in the colour of errors.
    fn write_wrong(&self, canvas: &mut Canvas<'_>, mistakes: &str, at: [u32; 2]) {
        let color = if self.ink == Rgb888::BLACK { WRONG[0] } else { WRONG[1] };
        Self::write_in(canvas, color, mistakes, at);
    }

    fn write_in(canvas: &mut Canvas<'_>, color: Rgb888, text: &str, [left, top]: [u32; 2]) {
        let style = MonoTextStyle::new(FONT, color);
        let at = Point::new(left as i32, top as i32);
        let Ok(_) = Text::with_baseline(text, at, style, Baseline::Top).draw(canvas);
    }
}

/// The meaning of the colours of a view.
fn colors_of(options: &RenderOptions) -> Vec<Key> {
    match options.view {
        View::Angle => vec![
            Key { color: options.heat.flip, sign: Sign::Stripes, meaning: "opposite signs" },
            key(options.heat.none, "no tangent"),
        ],
        View::Tangent | View::Bitangent | View::Normal => {
            vec![key([255, 128, 128], "+x"), key([128, 255, 128], "+y"), key([128, 128, 255], "+z")]
        }
        View::Shaded if options.layout.is_none() => Vec::new(),
        View::TestBumps if options.layout.is_none() => vec![key(BUMPS, "test bumps: not in the file")],
        _ => vec![key(SIGN_COLORS[0], "w = 1"), key(SIGN_COLORS[1], "w = -1")],
    }
}

/// Draws the sign of a key in a square.
fn draw_sign(canvas: &mut Canvas<'_>, sign: Sign, color: [u8; 3], [left, top]: [u32; 2]) {
    match sign {
        Sign::Square => canvas.fill([left, top], [BAR, BAR], color),
        Sign::Stripes => (0..BAR * BAR).map(|at| [at % BAR, at / BAR]).for_each(|[x, y]| {
            let stripe = if (x + y) % 5 < 2 { [255; 3] } else { color };
            canvas.fill([left + x, top + y], [1, 1], stripe);
        }),
        Sign::Dashes(count) => {
            let step = BAR / count;
            let drawn = if count > 1 { (step * 6 / 10).max(1) } else { step };
            (0..count)
                .for_each(|dash| canvas.fill([left + dash * step, top + BAR / 2 - 1], [drawn, 3], color));
        }
    }
}

/// The colour beside the legend of test bumps.
const BUMPS: [u8; 3] = [242, 193, 78];

/// The mistakes of `--mistakes` in words.
fn mistakes_of(arguments: &RenderArguments) -> String {
    use ShaderMistake::{Green, V, W};
    let made = |mistake: &MistakeChoice| {
        let flips = matches!(mistake, MistakeChoice::Shader(Green | W | V));
        format!("{}{}", mistake.name(), if flips { " flipped" } else { "" })
    };
    let made: Vec<String> = arguments.mistakes.iter().map(made).collect();
    if made.is_empty() { String::new() } else { format!("x mistake: {}", made.join(", ")) }
}

/// The captions of the sides of `--split`.
fn sides_of(arguments: &RenderArguments, source: TangentSource) -> Option<([Caption; 2], f64)> {
    let left = Caption { source: source.name(), mistakes: String::new() };
    let right =
        Caption { source: arguments.against.unwrap_or(source).name(), mistakes: mistakes_of(arguments) };
    Some(([left, right], arguments.split? / 100.0))
}

fn key_width(meaning: &str) -> u32 {
    BAR + GAP / 2 + LETTER * meaning.len() as u32 + 2 * GAP
}

fn widths(keys: &[Key]) -> u32 {
    keys.iter().map(|key| key_width(key.meaning)).sum()
}

/// The pixels of a picture.
struct Canvas<'a> {
    width: u32,
    pixels: &'a mut [[u8; 3]],
}

impl Canvas<'_> {
    fn fill(&mut self, [left, top]: [u32; 2], [width, height]: [u32; 2], color: [u8; 3]) {
        for row in top..top + height {
            (left..left + width).for_each(|column| self.set_pixel(column, row, color));
        }
    }

    /// Sets a pixel; pixels outside the picture are ignored.
    fn set_pixel(&mut self, column: u32, row: u32, color: [u8; 3]) {
        let at = row as usize * self.width as usize + column as usize;
        if let Some(pixel) = self.pixels.get_mut(at).filter(|_| column < self.width) {
            *pixel = color;
        }
    }
}

impl Dimensions for Canvas<'_> {
    fn bounding_box(&self) -> Rectangle {
        let rows = self.pixels.len() / (self.width as usize).max(1);
        Rectangle::new(Point::zero(), Size::new(self.width, rows as u32))
    }
}

impl DrawTarget for Canvas<'_> {
    type Color = Rgb888;
    type Error = Infallible;

    fn draw_iter<I: IntoIterator<Item = Pixel<Rgb888>>>(&mut self, pixels: I) -> Result<(), Infallible> {
        for Pixel(Point { x, y }, color) in pixels {
            if let (Ok(column), Ok(row)) = (u32::try_from(x), u32::try_from(y)) {
                self.set_pixel(column, row, [color.r(), color.g(), color.b()]);
            }
        }
        Ok(())
    }
}
