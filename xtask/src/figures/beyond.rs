//! What else frames are for: anisotropy, triplanar projection, detail normals, displacement, parallax.

use super::drawing::{Figure, Side};
use super::plane::{Vec2, direction, vec2};

/// A brushed disc: the highlight lies across the brush strokes.
pub fn anisotropy() -> Figure {
    let mut figure = Figure::new(
        720,
        270,
        "Anisotropy follows the tangent",
        "A brushed disc. The tangents run along the strokes, in circles. Where the half vector is perpendicular to the tangent, the highlight is bright: \
         along a line through the centre, not in a spot.",
    );
    let centre = vec2(180.0, 135.0);
    for radius in [30.0, 50.0, 70.0, 90.0, 105.0] {
        figure.arc(centre, radius, 0.0, 359.9, "guide");
    }
    let half = direction(90.0);
    for degrees in (0..360).step_by(30) {
        let out = vec2(direction(f64::from(degrees)).x, -direction(f64::from(degrees)).y);
        let along = out.turned();
        let (middle, reach) = (centre + out * 80.0, 16.0);
        figure.arrow(middle - along * reach, middle + along * reach, "tangent");
        // The brightness of Kajiya and Kay: the sine between tangent and half vector.
        let sine = (1.0 - half.dot(along).powi(2)).max(0.0).sqrt();
        let shown = format!("{:.0} %", 100.0 * sine.powi(16));
        figure.label(
            centre + out * 118.0 + vec2(0.0, 4.0),
            &shown,
            "small quiet",
            if out.x < -0.1 {
                Side::Left
            } else if out.x > 0.1 {
                Side::Right
            } else {
                Side::Centre
            },
        );
    }
    let words = [
        "T runs along the strokes of the brush.",
        "H, the direction between light and eye,",
        "leans up here. The highlight is strong",
        "where T is perpendicular to H:",
        "(1 − (T · H)²) to the power of 8.",
    ];
    figure.lines(vec2(370.0, 90.0), &words, "", Side::Right);
    figure.arrow(vec2(345.0, 180.0), vec2(345.0, 110.0), "dark");
    figure.label(vec2(345.0, 196.0), "H", "symbol", Side::Centre);
    figure
}

/// Weights of three projections from the normal.
pub fn triplanar() -> Figure {
    let mut figure = Figure::new(
        720,
        250,
        "Triplanar projection",
        "A bent ground. Where its normal points up, the texture is projected from above, where it points to the side, from the side. Between, both are \
         mixed by the components of the normal.",
    );
    let centre = vec2(150.0, 220.0);
    figure.arc(centre, 150.0, 0.0, 90.0, "ink");
    for (row, degrees) in [90.0, 60.0, 45.0, 30.0, 0.0].into_iter().enumerate() {
        let up = direction(degrees);
        let out = vec2(up.x, -up.y);
        figure.arrow(centre + out * 150.0, centre + out * 190.0, "normal");
        let (x, y) = (up.x.powi(4), up.y.powi(4));
        let (from_side, from_above) = (100.0 * x / (x + y), 100.0 * y / (x + y));
        let top = 40.0 + 36.0 * row as f64;
        figure.label(vec2(400.0, top + 15.0), &format!("{degrees:.0}°"), "small", Side::Left);
        figure.cell(vec2(420.0, top), vec2(2.2 * from_above, 26.0), "other line");
        figure.cell(vec2(420.0 + 2.2 * from_above, top), vec2(2.2 * from_side, 26.0), "mirrored line");
        let shown = format!("{from_above:.0} : {from_side:.0}");
        figure.label(vec2(648.0, top + 15.0), &shown, "small", Side::Right);
    }
    figure.label(
        vec2(420.0, 24.0),
        "from above : from the side, in percent (n⁴)",
        "small quiet",
        Side::Right,
    );
    figure
}

/// Two maps on one surface: the slopes are added.
pub fn detail_normals() -> Figure {
    let mut figure = Figure::new(
        720,
        260,
        "Detail normals",
        "Three profiles: a coarse wave, a fine wave, and their sum. The slopes of the sum are the sums of the slopes.",
    );
    let coarse = |x: f64| 18.0 * (x / 70.0).sin();
    let fine = |x: f64| 5.0 * (x / 12.0).sin();
    let rows: [(&str, &dyn Fn(f64) -> f64); 3] =
        [("base", &coarse), ("detail", &fine), ("base + detail", &|x| coarse(x) + fine(x))];
    for (row, (name, height)) in rows.into_iter().enumerate() {
        let middle = 55.0 + 72.0 * row as f64;
        let points: Vec<Vec2> = (0..=220)
            .map(|step| 2.0 * f64::from(step))
            .map(|x| vec2(150.0 + x, middle - height(x)))
            .collect();
        figure.curve(&points, "ink");
        figure.label(vec2(130.0, middle), name, "small", Side::Left);
        for x in [60.0, 200.0, 340.0] {
            let slope = height(x + 0.5) - height(x - 0.5);
            let at = vec2(150.0 + x, middle - height(x));
            figure.arrow(at, at + vec2(-slope, -1.0).unit() * 30.0, "normal");
        }
    }
    figure.label(
        vec2(360.0, 243.0),
        "Add slopes (x/z, y/z), not colours. Adding texels flattens both.",
        "small quiet",
        Side::Centre,
    );
    figure
}

/// Points move along the normal; the frame of the moved surface follows from the slopes.
pub fn displacement() -> Figure {
    let mut figure = Figure::new(
        720,
        240,
        "Displacement",
        "A flat surface and the surface after each point was moved along the normal by a height. The new normal is perpendicular to the moved surface.",
    );
    let height = |x: f64| 45.0 * (-((x - 210.0) / 80.0).powi(2)).exp();
    let (left, ground) = (110.0, 190.0);
    figure.line(vec2(left, ground), vec2(left + 420.0, ground), "quiet line dashed");
    let points: Vec<Vec2> =
        (0..=210).map(|step| 2.0 * f64::from(step)).map(|x| vec2(left + x, ground - height(x))).collect();
    figure.curve(&points, "ink");
    for x in [90.0, 150.0, 210.0, 270.0, 330.0] {
        figure.arrow(vec2(left + x, ground), vec2(left + x, ground - height(x)), "bitangent");
        let slope = height(x + 0.5) - height(x - 0.5);
        let at = vec2(left + x, ground - height(x));
        figure.arrow(at, at + vec2(-slope, -1.0).unit() * 55.0, "normal");
    }
    figure.label(vec2(left + 430.0, ground), "P", "symbol", Side::Right);
    figure.label(vec2(left + 430.0, ground - 40.0), "P + h n", "symbol", Side::Right);
    figure.label(
        vec2(360.0, 222.0),
        "new slope along T: dh/du divided by |P_u|, so the length of dP/du matters",
        "small quiet",
        Side::Centre,
    );
    figure
}

/// The ray of view in tangent space moves the UV.
pub fn parallax() -> Figure {
    let mut figure = Figure::new(
        720,
        250,
        "Parallax",
        "A ray of view hits the flat surface at one UV. The height field below the surface is hit further on. The UV moves by the height times the ray's \
         slope.",
    );
    let depth = |x: f64| 50.0 + 24.0 * (x / 38.0).sin();
    let (left, ground) = (90.0, 90.0);
    figure.line(vec2(left, ground), vec2(left + 480.0, ground), "quiet line dashed");
    let points: Vec<Vec2> =
        (0..=240).map(|step| 2.0 * f64::from(step)).map(|x| vec2(left + x, ground + depth(x))).collect();
    figure.curve(&points, "ink");
    let (entry, ray) = (vec2(200.0, 0.0), vec2(1.6, 1.0));
    let hit = (1..2000)
        .map(|step| entry + ray * (0.1 * f64::from(step)))
        .find(|at| at.y >= depth(at.x))
        .unwrap_or(entry);
    let on = |at: Vec2| vec2(left + at.x, ground + at.y);
    figure.arrow(on(entry - ray * 45.0), on(entry), "dark");
    figure.line(on(entry), on(hit), "ink line dashed");
    figure.point(on(entry));
    figure.point(on(hit));
    figure.arrow(on(entry), on(vec2(hit.x, 0.0)), "tangent");
    figure.label(on(vec2(hit.x + 10.0, -12.0)), "moved along T", "small tangent", Side::Right);
    figure.label(on(entry - ray * 45.0) + vec2(-8.0, 0.0), "eye", "small", Side::Left);
    figure.label(vec2(left + 490.0, ground), "surface", "small quiet", Side::Right);
    figure.label(vec2(left + 490.0, ground + 50.0), "height map", "small quiet", Side::Right);
    figure.label(
        vec2(360.0, 225.0),
        "shift = depth × V.xy / V.z in tangent space, divided by |P_u| and |P_v| for UVs",
        "small quiet",
        Side::Centre,
    );
    figure
}
