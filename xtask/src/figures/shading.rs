//! The frame in shaders: columns of a matrix, and transforms.

use super::drawing::{Figure, Side};
use super::plane::{Vec2, View, direction, vec2};

/// The columns T, B, n times a texel.
pub fn matrix_columns() -> Figure {
    let mut figure = Figure::new(
        720,
        240,
        "The columns of the matrix are T, B and n",
        "A matrix with the columns tangent, bitangent and normal is multiplied with a texel. The result is red times T plus green times B \
         plus blue times n.",
    );
    let (top, height) = (50.0, 110.0);
    for (column, (name, class)) in
        [("T", "tangent"), ("B", "bitangent"), ("n", "normal")].into_iter().enumerate()
    {
        let left = 80.0 + 60.0 * column as f64;
        figure.cell(vec2(left, top), vec2(44.0, height), "face line");
        for (row, axis) in ["x", "y", "z"].into_iter().enumerate() {
            figure.symbol(vec2(left + 19.0, top + 22.0 + 33.0 * row as f64), name, axis, class);
        }
    }
    bracket(&mut figure, 66.0, top - 8.0, height + 16.0, 1.0);
    bracket(&mut figure, 258.0, top - 8.0, height + 16.0, -1.0);
    for (row, name) in ["red", "green", "blue"].into_iter().enumerate() {
        figure.label(vec2(310.0, top + 22.0 + 33.0 * row as f64), name, "small", Side::Centre);
    }
    bracket(&mut figure, 276.0, top - 8.0, height + 16.0, 1.0);
    bracket(&mut figure, 344.0, top - 8.0, height + 16.0, -1.0);
    figure.label(vec2(366.0, top + 55.0), "=", "", Side::Centre);
    let mut left = 390.0;
    for (words, class) in [
        ("red", ""),
        ("T", "symbol tangent"),
        ("+ green", ""),
        ("B", "symbol bitangent"),
        ("+ blue", ""),
        ("n", "symbol normal"),
    ] {
        figure.label(vec2(left, top + 55.0), words, class, Side::Right);
        left += 9.0 * words.len() as f64 + 14.0;
    }
    figure.label(vec2(360.0, 205.0), "Test: the texel (0, 0, 1) must give n.", "quiet", Side::Centre);
    figure
}

fn bracket(figure: &mut Figure, x: f64, top: f64, height: f64, inwards: f64) {
    let points = [(8.0 * inwards, 0.0), (0.0, 0.0), (0.0, height), (8.0 * inwards, height)];
    figure.curve(&points.map(|(right, down)| vec2(x + right, top + down)), "ink");
}

/// A circle that is scaled to an ellipse: tangents go with the matrix, normals with its inverse transpose.
pub fn non_uniform_scale() -> Figure {
    let mut figure = Figure::new(
        720,
        290,
        "Non-uniform scale",
        "A circle with a tangent and a normal is scaled to twice its width. The tangent, transformed by the matrix, still touches the \
         ellipse. The normal, transformed by the same matrix, leans; by the inverse transpose it stays perpendicular.",
    );
    let degrees = 52.0;
    let (base, normal) = (direction(degrees), direction(degrees));
    let tangent = -normal.turned();
    let scale = |point: Vec2| vec2(2.0 * point.x, point.y);
    let inverse_transpose = |way: Vec2| vec2(way.x / 2.0, way.y);
    let ring: Vec<Vec2> = (0..=90).map(|step| direction(f64::from(step) * 4.0)).collect();
    let [before, after] = [View::new(100.0, 185.0, 72.0), View::new(390.0, 185.0, 72.0)];
    figure.curve(&ring.iter().map(|point| before.at(*point)).collect::<Vec<_>>(), "ink");
    figure.curve(&ring.iter().map(|point| after.at(scale(*point))).collect::<Vec<_>>(), "ink");
    figure.arrow(before.at(base), before.at(base + tangent * 0.75), "tangent");
    figure.arrow(before.at(base), before.at(base + normal * 0.75), "normal");
    let start = scale(base);
    let right = inverse_transpose(normal).unit();
    let wrong = scale(normal).unit();
    let moved = scale(tangent).unit();
    figure.arrow(after.at(start), after.at(start + moved * 0.85), "tangent");
    figure.arrow(after.at(start), after.at(start + right * 0.85), "normal");
    figure.arrow(after.at(start), after.at(start + wrong * 0.85), "normal dashed");
    figure.label(before.at(base + normal * 0.9), "n", "symbol normal", Side::Centre);
    figure.label(before.at(base + tangent * 0.9), "T", "symbol tangent", Side::Centre);
    figure.label(after.at(start + moved * 0.85) + vec2(8.0, 8.0), "M T", "symbol tangent", Side::Right);
    figure.label(
        after.at(start + right * 0.92) + vec2(-20.0, -12.0),
        "inverse transpose of M, times n",
        "small normal",
        Side::Right,
    );
    figure.label(
        after.at(start + wrong * 0.85) + vec2(8.0, -2.0),
        "M n: not perpendicular",
        "small",
        Side::Right,
    );
    figure.label(vec2(226.0, 205.0), "M →", "symbol", Side::Left);
    figure
}

/// Half the angle in degrees between the normals at both ends of the edge of [`interpolated_vectors`].
const BEND: f64 = 45.0;

/// An edge of a coarse mesh: interpolated vectors as they are, and normalised.
pub fn interpolated_vectors() -> Figure {
    let shortened = BEND.to_radians().cos();
    let as_it_is = vec2(1.0, shortened).unit();
    let normalised = vec2(1.0, 1.0).unit();
    let apart = as_it_is.dot(normalised).acos().to_degrees();
    let mut figure = Figure::new(
        720,
        270,
        "Interpolated vectors, as they are and normalised",
        &format!(
            "Left, the normals at both ends of an edge differ by 90 degrees. Halfway, their interpolation is shorter than 1. Right, the same texel \
             in the plane of T and n: with the short n, as the baker had it, and with n normalised. The directions are {apart:.1} degrees apart."
        ),
    );
    let view = View::new(180.0, 195.0, 88.0);
    let ends = [vec2(-1.0, 0.0), vec2(1.0, 0.0)];
    let normals = [direction(90.0 + BEND), direction(90.0 - BEND)];
    figure.line(view.at(ends[0]), view.at(ends[1]), "ink");
    for step in 0..=4 {
        let share = f64::from(step) / 4.0;
        let start = ends[0].towards(ends[1], share);
        figure.arrow(view.at(start), view.at(start + normals[0].towards(normals[1], share)), "normal");
    }
    figure.label(
        view.at(vec2(0.0, -0.2)),
        "interpolated normals: shorter between the ends",
        "small",
        Side::Centre,
    );
    let view = View::new(440.0, 205.0, 120.0);
    let origin = vec2(0.0, 0.0);
    figure.arrow(view.at(origin), view.at(vec2(1.0, 0.0)), "tangent");
    figure.arrow(view.at(origin), view.at(vec2(0.0, shortened)), "normal");
    figure.arrow(view.at(origin), view.at(vec2(0.0, 1.0)), "normal dashed");
    figure.arrow(view.at(origin), view.at(as_it_is * 1.2), "dark");
    figure.arrow(view.at(origin), view.at(normalised * 1.2), "dark dashed");
    figure.label(view.at(vec2(1.08, 0.0)), "T", "symbol tangent", Side::Right);
    figure.label(view.at(vec2(-0.08, shortened * 0.8)), "n", "symbol normal", Side::Left);
    figure.label(view.at(normalised * 1.2 + vec2(0.05, 0.04)), "normalised", "small", Side::Right);
    figure.label(view.at(as_it_is * 1.2 + vec2(0.05, -0.02)), "as it is", "small", Side::Right);
    figure.label(
        view.at(vec2(0.6, -0.2)),
        &format!("the texel (0.71, 0, 0.71): {apart:.1}° apart"),
        "small",
        Side::Centre,
    );
    figure
}

/// An arm that bends: frames that bend with it, and frames that stay as they were.
pub fn skinned_frames() -> Figure {
    let mut figure = Figure::new(
        720,
        270,
        "Frames that are skinned, and frames that are not",
        "Left, an arm at rest with its normals and tangents. In the middle, the arm is bent, and normals and tangents bend with it. Right, only \
         the positions are bent: normals and tangents have the directions of the arm at rest, and point into and along the wrong parts of the surface.",
    );
    for (x, bend, frames, words) in [
        (110.0, 0.0, 0.0, "at rest"),
        (350.0, 80.0, 80.0, "bent, frames too"),
        (590.0, 80.0, 0.0, "only positions are bent"),
    ] {
        let view = View::new(x, 130.0, 92.0);
        let (mut point, mut points) = (vec2(-0.95, 0.0), Vec::new());
        let mut shown = Vec::new();
        for step in 0..=30 {
            // The middle third bends.
            let bent = (f64::from(step) / 10.0 - 1.0).clamp(0.0, 1.0);
            let way = direction(-bend * bent);
            points.push(view.at(point));
            if step % 6 == 3 {
                shown.push((point, direction(-frames * bent)));
            }
            point = point + way * (2.0 / 30.0);
        }
        figure.curve(&points, "ink");
        for (start, along) in shown {
            figure.arrow(view.at(start), view.at(start + along * 0.3), "tangent");
            figure.arrow(view.at(start), view.at(start + along.turned() * 0.42), "normal");
        }
        figure.label(vec2(x, 250.0), words, "small", Side::Centre);
    }
    figure.label(vec2(30.0, 30.0), "normals", "small normal", Side::Right);
    figure.label(vec2(30.0, 50.0), "tangents", "small tangent", Side::Right);
    figure
}
