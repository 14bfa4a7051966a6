//! Mirrored UVs, signs, and groups of triangles that may share a tangent.

use super::drawing::{Figure, Side};
use super::plane::{Vec2, View, direction, vec2};

/// A shield whose halves share one half of the texture, before and after its vertices are split.
pub fn mirrored_seam() -> Figure {
    let mut figure = Figure::new(
        720,
        330,
        "A mirrored seam",
        "A shield whose left half is the mirror image of the right one in the texture. Left, every vertex has one tangent: at the seam the \
         tangents of both halves point in opposite directions and cancel. Right, each seam vertex was split into two, one for each half, \
         with w = -1 and w = +1.",
    );
    let half = [vec2(0.0, 1.1), vec2(0.8, 0.9), vec2(0.72, 0.1), vec2(0.0, -0.55)];
    let seam = [1.1, 0.55, 0.0, -0.55];
    for (x, gap) in [(180.0, 0.0), (530.0, 0.16)] {
        let view = View::new(x, 190.0, 130.0);
        for side in [1.0, -1.0] {
            let placed = |point: Vec2| view.at(vec2(side * (point.x + gap / 2.0), point.y));
            let class = if side > 0.0 { "face line" } else { "mirrored line" };
            figure.polygon(&half.map(placed), class);
            for row in [0.75, 0.3] {
                figure.arrow(placed(vec2(0.36, row)), placed(vec2(0.62, row)), "tangent");
            }
            if gap > 0.0 {
                for row in seam {
                    figure.point(placed(vec2(0.0, row)));
                    figure.arrow(placed(vec2(0.0, row)), placed(vec2(0.24, row)), "tangent");
                }
            }
            let name = if side > 0.0 { "w = +1" } else { "w = −1" };
            figure.label(placed(vec2(0.36, 0.1)), name, "small", Side::Centre);
        }
        if gap == 0.0 {
            for row in seam {
                figure.point(view.at(vec2(0.0, row)));
                figure.arrow(view.at(vec2(0.0, row)), view.at(vec2(0.11, row + 0.12)), "tangent");
            }
        }
        let words = if gap == 0.0 {
            "one tangent per vertex: noise at the seam"
        } else {
            "split: one tangent per side"
        };
        figure.label(vec2(x, 300.0), words, "", Side::Centre);
    }
    figure
}

/// The same bump with green up and with green down.
pub fn green_channel() -> Figure {
    let mut figure = Figure::new(
        720,
        235,
        "Green up and green down",
        "Two texels of the upper flank of the same bump. In a map of the OpenGL convention its green is above 128, in one of the DirectX \
         convention below. A renderer of the other convention lights the bump from below, and it looks like a dent.",
    );
    for (x, is_up, name) in
        [(150.0, true, "OpenGL, Y+: 128, 200, 236"), (460.0, false, "DirectX, Y−: 128, 56, 236")]
    {
        let view = View::new(x, 120.0, 70.0);
        let shape: Vec<Vec2> = (0..=40)
            .map(|step| {
                let height = f64::from(step) / 20.0 - 1.0;
                view.at(vec2(0.55 * (-6.0 * height * height).exp(), height))
            })
            .collect();
        figure.curve(&shape, "ink");
        let start = vec2(0.3, 0.32);
        figure.arrow(view.at(start), view.at(start + direction(32.0) * 0.75), "normal");
        figure.arrow(
            view.at(vec2(-0.35, 0.0)),
            view.at(vec2(-0.35, if is_up { 0.8 } else { -0.8 })),
            "bitangent",
        );
        figure.label(
            view.at(vec2(-0.6, if is_up { 0.6 } else { -0.6 })),
            "green",
            "small bitangent",
            Side::Left,
        );
        figure.swatch(view.at(vec2(1.35, 0.55)), 62.0, if is_up { [128, 200, 236] } else { [128, 56, 236] });
        figure.label(vec2(x + 40.0, 212.0), name, "small", Side::Centre);
    }
    figure
}

/// One position, three vertices, and the groups of MikkTSpace.
pub fn groups() -> Figure {
    let mut figure = Figure::new(
        720,
        320,
        "Groups at one position",
        "Eight triangles around one position. A UV seam, drawn as a thick line, and the edge of a mirrored part cut them into three groups: \
         four triangles, two mirrored triangles, and two triangles beyond the seam. Each group has one tangent.",
    );
    let view = View::new(190.0, 160.0, 125.0);
    let classes = ["face", "face", "face", "face", "mirrored", "mirrored", "other", "other"];
    let sides = [20.0, 65.0, 112.0, 160.0, 205.0, 250.0, 300.0, 340.0, 380.0];
    let centre = vec2(0.0, 0.0);
    for (face, class) in classes.into_iter().enumerate() {
        let corners =
            [centre, direction(sides[face]), direction(sides[face + 1])].map(|corner| view.at(corner));
        figure.polygon(&corners, &format!("{class} line"));
    }
    for (group, (degrees, way)) in [(90.0, 12.0), (228.0, 186.0), (338.0, 42.0)].into_iter().enumerate() {
        let start = direction(degrees) * 0.46 - direction(way) * 0.17;
        figure.arrow(view.at(start), view.at(start + direction(way) * 0.42), "tangent");
        figure.label(
            view.at(direction(degrees + 14.0) * 0.78),
            &(group + 1).to_string(),
            "title",
            Side::Centre,
        );
    }
    for degrees in [20.0, 300.0] {
        for shift in [-1.0, 0.0, 1.0] {
            let beside = direction(degrees).turned() * (shift / 125.0);
            figure.line(view.at(beside), view.at(direction(degrees) * 1.12 + beside), "ink");
        }
    }
    figure.point(view.at(centre));
    let words = [
        "Thick: UV seams. The vertices on both sides",
        "have other UVs, so they are not welded.",
        "",
        "1 and 2 share vertices, but 2 is mirrored:",
        "triangles of two orientations never join.",
        "",
        "1 and 3 have one orientation, but no",
        "welded edge connects them.",
    ];
    figure.lines(vec2(380.0, 96.0), &words, "small", Side::Right);
    figure
}
