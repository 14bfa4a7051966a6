//! A figure: shapes and words on a panel, with colours for light and dark pages.

use svg::node::element::{
    Circle, Description, Element, Line, Path, Polygon, Polyline, Rectangle, Style, Text, Title,
};
use svg::{Document, Node};

use super::plane::{Vec2, vec2};

/// Colours by class. Text and lines reach a contrast of 4.5 on the panel in both themes.
const STYLE: &str = "
:root { color-scheme: light dark; }
text { font: 15px system-ui, 'Segoe UI', 'DejaVu Sans', sans-serif; fill: #24242a; }
.title { font-weight: 600; } .small { font-size: 13px; } .code { font-family: ui-monospace, 'DejaVu Sans Mono', monospace; }
.symbol, .index { font-style: italic; font-weight: 600; } .index { font-size: 11px; }
.panel { fill: #fbfbf8; stroke: #d8d8d2; }
.ink { stroke: #24242a; } .quiet { stroke: #63636b; fill: #63636b; } .guide { stroke: #c4c4bd; }
text.quiet { fill: #63636b; stroke: none; } text.ink { stroke: none; }
.tangent { stroke: #b04008; fill: #b04008; } .bitangent { stroke: #00704b; fill: #00704b; } .normal { stroke: #0a5cad; fill: #0a5cad; }
text.tangent, text.bitangent, text.normal { stroke: none; }
.face { fill: #ecebe4; stroke: #24242a; } .other { fill: #dbe5f0; stroke: #24242a; } .mirrored { fill: #f3e0d3; stroke: #24242a; }
.dark { fill: #24242a; stroke: #24242a; } .line { stroke-width: 1.6; } .line.curve { fill: none; } .arrow { stroke-width: 2.2; } .dashed { stroke-dasharray: 5 4; }
@media (prefers-color-scheme: dark) {
text { fill: #ececef; }
.panel { fill: #1b1b20; stroke: #3a3a42; }
.ink { stroke: #ececef; } .quiet { stroke: #a5a5af; fill: #a5a5af; } .guide { stroke: #43434c; }
text.quiet { fill: #a5a5af; }
.tangent { stroke: #ff9a63; fill: #ff9a63; } .bitangent { stroke: #45cf9d; fill: #45cf9d; } .normal { stroke: #74b6ff; fill: #74b6ff; }
.face { fill: #2e2e35; stroke: #ececef; } .other { fill: #26374a; stroke: #ececef; } .mirrored { fill: #4a3326; stroke: #ececef; }
.dark { fill: #ececef; stroke: #ececef; }
}";

/// Where a label stands beside its point.
#[derive(Clone, Copy)]
pub enum Side {
    Left,
    Right,
    Centre,
}

/// A figure under construction. Coordinates are pixels, y downwards.
pub struct Figure {
    document: Document,
}

impl Figure {
    /// An empty panel. `title` names the figure, `description` says what is to be seen to those who cannot see it.
    pub fn new(width: u32, height: u32, title: &str, description: &str) -> Self {
        let panel = Rectangle::new()
            .set("class", "panel")
            .set("x", 0.5)
            .set("y", 0.5)
            .set("width", f64::from(width) - 1.0)
            .set("height", f64::from(height) - 1.0)
            .set("rx", 8);
        let document = Document::new()
            .set("viewBox", (0, 0, width, height))
            .set("width", width)
            .set("height", height)
            .set("role", "img")
            .set("aria-labelledby", "title description")
            .add(Title::new(title).set("id", "title"))
            .add(Description::new().set("id", "description").add(svg::node::Text::new(description)))
            .add(Style::new(STYLE))
            .add(panel);
        Self { document }
    }

    /// The file's text.
    pub fn text(&self) -> String {
        format!("{}\n", self.document)
    }

    pub fn line(&mut self, start: Vec2, end: Vec2, class: &str) {
        let line = Line::new()
            .set("class", format!("line {class}"))
            .set("x1", rounded(start.x))
            .set("y1", rounded(start.y))
            .set("x2", rounded(end.x))
            .set("y2", rounded(end.y));
        self.add(line);
    }

    /// A line with a filled head. A shaft that is shorter than its head has a smaller head.
    pub fn arrow(&mut self, start: Vec2, end: Vec2, class: &str) {
        let along = end - start;
        if along.length() < 1e-9 {
            return;
        }
        let head = (along.length() * 0.6).min(11.0);
        let (along, across) = (along.unit(), along.unit().turned());
        let base = end - along * head;
        self.line(start, base, &format!("arrow {class}"));
        self.polygon(&[end, base + across * (head * 0.42), base - across * (head * 0.42)], class);
    }

    pub fn polygon(&mut self, points: &[Vec2], class: &str) {
        self.add(Polygon::new().set("class", class).set("points", listed(points)));
    }

    pub fn curve(&mut self, points: &[Vec2], class: &str) {
        self.add(Polyline::new().set("class", format!("line curve {class}")).set("points", listed(points)));
    }

    pub fn point(&mut self, at: Vec2) {
        self.add(
            Circle::new()
                .set("class", "dark")
                .set("cx", rounded(at.x))
                .set("cy", rounded(at.y))
                .set("r", 3.5),
        );
    }

    /// A rectangle of one colour, given as channels from 0 to 255, with an outline.
    pub fn swatch(&mut self, at: Vec2, size: f64, [red, green, blue]: [u8; 3]) {
        let swatch = rectangle(at, vec2(size, size))
            .set("class", "ink")
            .set("fill", format!("#{red:02x}{green:02x}{blue:02x}"));
        self.add(swatch);
    }

    /// A rectangle by its upper left corner and its size.
    pub fn cell(&mut self, at: Vec2, size: Vec2, class: &str) {
        self.add(rectangle(at, size).set("class", class));
    }

    /// A part of a circle around `centre`, from one angle to another, in degrees, counter-clockwise as seen; y downwards.
    pub fn arc(&mut self, centre: Vec2, radius: f64, from: f64, to: f64, class: &str) {
        let at = |degrees: f64| {
            let way = super::plane::direction(degrees);
            centre + vec2(way.x, -way.y) * radius
        };
        let (start, end) = (at(from), at(to));
        let large = i32::from((to - from).abs() > 180.0);
        let sweep = i32::from(to < from);
        let data = format!(
            "M{} {} A{radius} {radius} 0 {large} {sweep} {} {}",
            rounded(start.x),
            rounded(start.y),
            rounded(end.x),
            rounded(end.y)
        );
        self.add(Path::new().set("class", format!("line curve {class}")).set("d", data));
    }

    /// Words on one line, whose middle height is about `at`.
    pub fn label(&mut self, at: Vec2, words: &str, class: &str, side: Side) {
        let anchor = match side {
            Side::Left => "end",
            Side::Right => "start",
            Side::Centre => "middle",
        };
        let text = Text::new(words)
            .set("class", class)
            .set("x", rounded(at.x))
            .set("y", rounded(at.y + 5.0))
            .set("text-anchor", anchor);
        self.add(text);
    }

    /// Several lines of words below each other; the first is about `at`.
    pub fn lines(&mut self, at: Vec2, lines: &[&str], class: &str, side: Side) {
        for (line, words) in lines.iter().enumerate() {
            self.label(at + vec2(0.0, 19.0 * line as f64), words, class, side);
        }
    }

    /// A symbol with an index below it, such as P and u.
    pub fn symbol(&mut self, at: Vec2, base: &str, index: &str, class: &str) {
        self.label(at, base, &format!("symbol {class}"), Side::Centre);
        self.label(at + vec2(6.0, 5.0), index, &format!("index {class}"), Side::Right);
    }

    fn add(&mut self, element: impl Into<Element> + Node) {
        self.document.append(element);
    }
}

fn rectangle(at: Vec2, size: Vec2) -> Rectangle {
    Rectangle::new()
        .set("x", rounded(at.x))
        .set("y", rounded(at.y))
        .set("width", rounded(size.x))
        .set("height", rounded(size.y))
}

/// To a tenth of a pixel, so that files are small and the same on every machine.
fn rounded(value: f64) -> f64 {
    (value * 10.0).round() / 10.0 + 0.0
}

fn listed(points: &[Vec2]) -> String {
    let list: Vec<String> = points.iter().map(|at| format!("{},{}", rounded(at.x), rounded(at.y))).collect();
    list.join(" ")
}
