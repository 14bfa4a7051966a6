//! The legend below a picture, which explains its colours, and the names of its two sides.

use std::convert::Infallible;

use clap::ValueEnum;
use darboux_render::{LINE_COLORS, Picture, RenderOptions, SEAM_COLOR, SIGN_COLORS, View};
use embedded_graphics::mono_font::iso_8859_1::FONT_6X13;
use embedded_graphics::mono_font::{MonoFont, MonoTextStyle};
use embedded_graphics::pixelcolor::{Rgb888, RgbColor};
use embedded_graphics::prelude::{Dimensions, DrawTarget, Point, Size};
use embedded_graphics::primitives::Rectangle;
use embedded_graphics::text::{Baseline, Text};
use embedded_graphics::{Drawable, Pixel};

use super::arguments::{MistakeChoice, RenderArguments, TangentSource};
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

/// A colour and its meaning.
type Key = ([u8; 3], &'static str);

/// The legend of a picture.
pub struct Legend {
    keys: Vec<Key>,
    has_scale: bool,
    /// The names of the left and the right side, and the position of the divide as a fraction of the width.
    names: Option<([String; 2], f64)>,
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
        let drawn = vectors.into_iter().zip(LINE_COLORS).filter(|((is_drawn, _), _)| *is_drawn);
        keys.extend(drawn.map(|((_, name), color)| (color, name)));
        keys.extend(options.seams.then_some((SEAM_COLOR, "mirrored seam")));
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
            names: names_of(arguments, source).filter(|_| fits),
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
        if let Some(([left, right], part)) = &self.names {
            let middle = (f64::from(width) * part).round() as u32;
            canvas.fill([middle, 0], [1, height], [self.ink.r(), self.ink.g(), self.ink.b()]);
            let from = middle.saturating_sub(GAP + LETTER * left.chars().count() as u32);
            self.write(&mut canvas, left, [from, GAP]);
            self.write(&mut canvas, right, [middle + GAP, GAP]);
        }
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
        for &(color, meaning) in keys {
            let [square, text] = [[left, top + (LINE - BAR) / 2], [left + BAR + GAP / 2, top]];
            canvas.fill(square, [BAR, BAR], color);
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

    fn write(&self, canvas: &mut Canvas<'_>, text: &str, [left, top]: [u32; 2]) {
        let style = MonoTextStyle::new(FONT, self.ink);
        let at = Point::new(left as i32, top as i32);
        let Ok(_) = Text::with_baseline(text, at, style, Baseline::Top).draw(canvas);
    }
}

/// The meaning of the colours of a view.
fn colors_of(options: &RenderOptions) -> Vec<Key> {
    match options.view {
        View::Angle => vec![(options.heat.flip, "opposite signs"), (options.heat.none, "no tangent")],
        View::Tangent | View::Bitangent | View::Normal => {
            vec![([255, 128, 128], "+x"), ([128, 255, 128], "+y"), ([128, 128, 255], "+z")]
        }
        View::Shaded if options.layout.is_none() => Vec::new(),
        _ => vec![(SIGN_COLORS[0], "w = 1"), (SIGN_COLORS[1], "w = -1")],
    }
}

/// The names of the sides of `--split`.
fn names_of(arguments: &RenderArguments, source: TangentSource) -> Option<([String; 2], f64)> {
    let made = |mistake: &MistakeChoice| {
        let value = mistake.to_possible_value()?;
        let flips = matches!(mistake, MistakeChoice::Green | MistakeChoice::W | MistakeChoice::V);
        Some(format!("{}{}", value.get_name(), if flips { " flipped" } else { "" }))
    };
    let against = arguments.against.map(|source| source.name());
    let right: Vec<String> = against.into_iter().chain(arguments.mistakes.iter().filter_map(made)).collect();
    Some(([source.name(), right.join(", ")], arguments.split? / 100.0))
}

fn key_width(meaning: &str) -> u32 {
    BAR + GAP / 2 + LETTER * meaning.len() as u32 + 2 * GAP
}

fn widths(keys: &[Key]) -> u32 {
    keys.iter().map(|(_, meaning)| key_width(meaning)).sum()
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
