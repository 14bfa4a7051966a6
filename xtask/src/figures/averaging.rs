//! Sums at vertices: why they are needed, how they are weighted, and how the result becomes perpendicular to the normal.

use super::drawing::{Figure, Side};
use super::plane::{Vec2, View, direction, vec2};

/// Two triangles that share an edge, from the side: one tangent per face, and one per vertex, interpolated.
pub fn shared_edge() -> Figure {
    let mut figure = Figure::new(
        720,
        250,
        "One tangent per triangle, and one per vertex",
        "Two triangles that meet at an edge, seen from the side like a roof. Left, each triangle has one tangent, and it jumps at the edge. \
         Right, the tangents of both are averaged at the shared edge and interpolated between, and nothing jumps.",
    );
    let profile = [vec2(-1.3, 0.0), vec2(0.0, 0.62), vec2(1.3, 0.0)];
    let along = [(profile[1] - profile[0]).unit(), (profile[2] - profile[1]).unit()];
    let shared = (along[0] + along[1]).unit();
    for (x, is_averaged) in [(185.0, false), (535.0, true)] {
        let view = View::new(x, 165.0, 110.0);
        figure.curve(&profile.map(|point| view.at(point)), "ink");
        for face in 0..2 {
            for step in 0..5 {
                let share = (f64::from(step) + if is_averaged { 0.0 } else { 0.5 }) / 5.0;
                let start = profile[face].towards(profile[face + 1], share);
                let ends = if face == 0 { [along[0], shared] } else { [shared, along[1]] };
                let way = if is_averaged { ends[0].towards(ends[1], share) } else { along[face] };
                let lifted = start + way.turned() * 0.07;
                figure.arrow(view.at(lifted), view.at(lifted + way * 0.22), "tangent");
            }
        }
        figure.point(view.at(profile[1]));
        let words = if is_averaged {
            "averaged at vertices, interpolated"
        } else {
            "one per triangle: a jump at the edge"
        };
        figure.label(vec2(x, 215.0), words, "", Side::Centre);
    }
    figure
}

/// The sum of tangents loses its part along the normal.
pub fn gram_schmidt() -> Figure {
    let mut figure = Figure::new(
        720,
        270,
        "Gram-Schmidt: the tangent loses its part along the normal",
        "The summed tangent T leans out of the plane that is perpendicular to the vertex normal n. Its part along n, the length n dot T, is \
         subtracted. What remains lies in the plane and is normalised.",
    );
    let view = View::new(230.0, 215.0, 160.0);
    let normal = direction(90.0);
    let sum = vec2(1.25, 0.62);
    let part = normal * sum.dot(normal);
    let rest = sum - part;
    figure.line(view.at(vec2(-0.9, 0.0)), view.at(vec2(2.0, 0.0)), "guide");
    figure.label(view.at(vec2(-0.9, -0.1)), "plane perpendicular to n", "small quiet", Side::Right);
    figure.arrow(view.at(vec2(0.0, 0.0)), view.at(normal), "normal");
    figure.arrow(view.at(vec2(0.0, 0.0)), view.at(sum), "tangent dashed");
    figure.arrow(view.at(sum), view.at(rest), "quiet");
    figure.arrow(view.at(vec2(0.0, 0.0)), view.at(rest.unit()), "tangent");
    figure.arc(view.at(vec2(0.0, 0.0)), 24.0, 0.0, 90.0, "quiet");
    figure.label(view.at(normal + vec2(-0.12, 0.02)), "n", "symbol normal", Side::Centre);
    figure.label(view.at(sum + vec2(0.06, 0.08)), "T, the sum", "symbol tangent", Side::Right);
    figure.label(
        view.at(rest + part * 0.5 + vec2(0.08, 0.0)),
        "(n · T) n is subtracted",
        "small",
        Side::Right,
    );
    figure.label(view.at(rest.unit() + vec2(-0.14, -0.15)), "T′", "symbol tangent", Side::Centre);
    figure.label(vec2(480.0, 248.0), "T′ = unit(T − (n · T) n)", "code small", Side::Right);
    figure
}

/// Skewed UVs: the bitangent along v, and the bitangent that shaders compute.
pub fn two_bitangents() -> Figure {
    let mut figure = Figure::new(
        720,
        270,
        "Which bitangent?",
        "A square whose UV lines are skewed. The derivative P with index v follows the lines of constant u. The bitangent that a shader \
         computes, w times n cross T, is perpendicular to T instead.",
    );
    let view = View::new(190.0, 215.0, 165.0);
    let [along_u, along_v] = [vec2(1.0, 0.0), vec2(0.45, 1.0)];
    for step in 0..=4 {
        let share = f64::from(step) / 4.0;
        figure.line(view.at(along_u * share), view.at(along_u * share + along_v), "guide");
        figure.line(view.at(along_v * share), view.at(along_v * share + along_u), "guide");
    }
    let origin = vec2(0.0, 0.0);
    figure.arrow(view.at(origin), view.at(along_u * 0.8), "tangent");
    figure.arrow(view.at(origin), view.at(along_v * 0.8), "bitangent dashed");
    figure.arrow(view.at(origin), view.at(along_u.turned() * 0.8), "bitangent");
    figure.arc(view.at(origin), 24.0, 0.0, 90.0, "quiet");
    figure.label(view.at(vec2(0.86, -0.11)), "T", "symbol tangent", Side::Centre);
    figure.label(view.at(vec2(-0.09, 0.8)), "w (n × T)", "symbol bitangent", Side::Left);
    figure.symbol(view.at(vec2(0.28, 0.9)), "P", "v", "bitangent");
    let words = [
        "dashed: along v, as the UVs run",
        "solid: what a shader computes from",
        "n, T and w; MikkTSpace's bakers",
        "compute it in the same way",
    ];
    figure.lines(vec2(470.0, 90.0), &words, "small", Side::Right);
    figure
}

/// A triangle at the vertex of the weights figure: its sector, its two edges at the vertex, and its derivative along u.
struct Wedge {
    /// Degrees, counter-clockwise from x.
    from: f64,
    to: f64,
    /// Lengths of the edges at both ends of the sector.
    edges: [f64; 2],
    /// dP/du.
    along_u: Vec2,
}

impl Wedge {
    fn corners(&self) -> [Vec2; 3] {
        [vec2(0.0, 0.0), direction(self.from) * self.edges[0], direction(self.to) * self.edges[1]]
    }

    fn area(&self) -> f64 {
        let corners = self.corners();
        corners[1].cross(corners[2]) / 2.0
    }
}

/// One vertex of a bevel: four ways to weight its triangles.
pub fn weights() -> Figure {
    let mut figure = Figure::new(
        720,
        420,
        "Four weightings of the same three triangles",
        "A vertex with a large triangle whose tangent points right, a thin one of the same angle whose tangent points up to the right, and \
         a sliver whose stretched tangent points up. Four panels show each triangle's share of the sum and the direction of the sum, \
         without weights, weighted by the length of the derivative, by area and by angle.",
    );
    let wedges = [
        Wedge { from: 200.0, to: 290.0, edges: [1.25, 1.25], along_u: direction(0.0) * 1.0 },
        Wedge { from: 290.0, to: 380.0, edges: [1.25, 0.14], along_u: direction(45.0) * 1.0 },
        Wedge { from: 20.0, to: 32.0, edges: [0.14, 1.2], along_u: direction(90.0) * 3.0 },
    ];
    type Weight = fn(&Wedge) -> f64;
    let weightings: [(&str, Weight); 4] = [
        ("none", |_| 1.0),
        ("length of dP/du", |wedge| wedge.along_u.length()),
        ("area", Wedge::area),
        ("angle (MikkTSpace)", |wedge| wedge.to - wedge.from),
    ];
    let fan = View::new(165.0, 165.0, 105.0);
    let classes = ["face", "other", "mirrored"];
    for (wedge, class) in wedges.iter().zip(classes) {
        figure.polygon(&wedge.corners().map(|corner| fan.at(corner)), &format!("{class} line"));
    }
    for (wedge, name) in wedges.iter().zip(["A", "B", "C"]) {
        let corners = wedge.corners();
        let middle = corners[0] * 0.2 + corners[1].towards(corners[2], 0.5) * 0.7;
        let tail = wedge.along_u.unit() * 0.18;
        let beside = if name == "A" {
            vec2(-0.02, -0.02)
        } else if name == "B" {
            vec2(0.16, -0.3)
        } else {
            vec2(0.42, 0.22)
        };
        figure.arrow(fan.at(middle + beside - tail), fan.at(middle + beside + tail), "tangent");
        figure.label(fan.at(middle + beside - tail * 1.75), name, "title", Side::Centre);
    }
    figure.point(fan.at(vec2(0.0, 0.0)));
    let words = [
        "A: large. B: the same angle, thin.",
        "C: a sliver, its UVs stretched",
        "three times.",
        "Arrows: directions of dP/du.",
    ];
    figure.lines(vec2(36.0, 336.0), &words, "small quiet", Side::Right);
    for (row, (name, weight)) in weightings.into_iter().enumerate() {
        let top = 24.0 + 97.0 * row as f64;
        figure.label(vec2(330.0, top + 10.0), name, "title", Side::Right);
        let total: f64 = wedges.iter().map(weight).sum();
        let mut left = 330.0;
        for ((wedge, class), letter) in wedges.iter().zip(classes).zip(["A", "B", "C"]) {
            let share = weight(wedge) / total;
            figure.cell(vec2(left, top + 26.0), vec2(220.0 * share, 24.0), &format!("{class} line"));
            if share > 0.08 {
                let percent =
                    if share > 0.25 { format!("{letter} {:.0} %", 100.0 * share) } else { letter.to_owned() };
                figure.label(vec2(left + 110.0 * share, top + 38.0), &percent, "small", Side::Centre);
            }
            left += 220.0 * share;
        }
        let sum = wedges.iter().fold(vec2(0.0, 0.0), |sum, wedge| sum + wedge.along_u.unit() * weight(wedge));
        let view = View::new(600.0, top + 62.0, 56.0);
        figure.arc(view.origin, 56.0, 0.0, 90.0, "guide");
        figure.line(view.origin, view.at(vec2(1.0, 0.0)), "guide");
        figure.arrow(view.origin, view.at(sum.unit()), "tangent");
        let degrees = format!("{:.0}°", sum.y.atan2(sum.x).to_degrees());
        figure.label(vec2(668.0, top + 40.0), &degrees, "small", Side::Right);
    }
    figure
}
