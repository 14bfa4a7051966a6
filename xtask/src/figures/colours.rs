//! What a texel's colour means.

use super::drawing::{Figure, Side};
use super::plane::{Vec2, View, direction, vec2};

/// A direction of unit length as the colour of a texel: 255 (c + 1) / 2 per channel, rounded.
fn colour(direction: [f64; 3]) -> [u8; 3] {
    direction.map(|component| (255.0 * (component + 1.0) / 2.0).round() as u8)
}

/// Three texels and their directions, seen from the side.
pub fn texel() -> Figure {
    let mut figure = Figure::new(
        720,
        262,
        "A texel is a direction in the frame of the surface",
        "Three texels with the directions that they store, drawn in a frame whose tangent points right and whose normal points up. \
         The colour 128, 128, 255 is the normal itself. More red leans the direction towards the tangent, less red away from it.",
    );
    for (column, lean) in [0.0, 45.0, -45.0].into_iter().enumerate() {
        let way = direction(90.0 - lean);
        let texel = colour([way.x, 0.0, way.y]);
        let view = View::new(150.0 + 220.0 * column as f64, 168.0, 92.0);
        figure.line(view.at(vec2(-0.8, 0.0)), view.at(vec2(0.8, 0.0)), "ink");
        figure.arrow(view.at(vec2(0.0, 0.0)), view.at(vec2(0.62, 0.0)), "tangent");
        figure.label(view.at(vec2(0.74, 0.17)), "T", "symbol tangent", Side::Centre);
        if lean == 0.0 {
            figure.label(view.at(vec2(0.14, 1.12)), "N", "symbol normal", Side::Centre);
        } else {
            figure.arrow(view.at(vec2(0.0, 0.0)), view.at(vec2(0.0, 1.0)), "normal dashed");
            figure.label(view.at(vec2(0.0, 1.15)), "N", "symbol normal", Side::Centre);
        }
        figure.arrow(view.at(vec2(0.0, 0.0)), view.at(way), "dark");
        figure.swatch(view.at(vec2(-0.22, -0.18)), 40.0, texel);
        let channels = texel.map(|channel| channel.to_string()).join(", ");
        figure.label(view.at(vec2(0.0, -0.82)), &channels, "code small", Side::Centre);
    }
    figure
}

/// A bump at three places of a bent strip, and its colour in each kind of map.
pub fn object_or_tangent() -> Figure {
    let mut figure = Figure::new(
        720,
        300,
        "Object space and tangent space",
        "A strip that bends over an arch has the same bump at three places. In a map in object space the three bumps have three \
         colours, because the colour stores the direction in space. In a map in tangent space they have one colour, because it stores \
         the direction relative to the surface.",
    );
    let view = View::new(360.0, 258.0, 170.0);
    let arch = |degrees: f64| direction(degrees) * 1.15;
    let points: Vec<Vec2> = (24..=156).map(|degrees| view.at(arch(f64::from(degrees)))).collect();
    figure.curve(&points, "ink");
    let lean = 30.0;
    let relative = direction(90.0 - lean);
    let in_tangent_space = colour([relative.x, 0.0, relative.y]);
    for (degrees, left) in [(146.0, 158.0), (90.0, 316.0), (34.0, 474.0)] {
        let (base, out) = (arch(degrees), direction(degrees));
        let way = direction(degrees - lean);
        figure.arrow(view.at(base), view.at(base + out * 0.3), "normal dashed");
        figure.arrow(view.at(base), view.at(base - out.turned() * 0.24), "tangent");
        figure.arrow(view.at(base), view.at(base + way * 0.34), "dark");
        figure.swatch(vec2(left, 196.0), 40.0, colour([way.x, way.y, 0.0]));
        figure.swatch(vec2(left + 46.0, 196.0), 40.0, in_tangent_space);
    }
    let words = ["the same bump at the three places, as a texel", "left: object space, right: tangent space"];
    figure.lines(vec2(360.0, 256.0), &words, "small quiet", Side::Centre);
    figure.label(view.at(arch(146.0) + direction(146.0) * 0.38), "N", "symbol normal", Side::Centre);
    figure.label(view.at(arch(146.0) + vec2(0.22, 0.12)), "T", "symbol tangent", Side::Centre);
    figure
}
