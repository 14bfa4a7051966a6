//! Mistakes that are made so large that a picture shows them, where those of the tests are too small.

use darboux::Method;
use darboux_check::Code;

use super::maps::Map;
use super::models::Model;

/// The healthy model of the pictures with a large mistake; none where the mistake of the tests can be seen,
/// or none can be made.
pub fn shown_mistake(healthy: &Model, code: Code) -> Option<Model> {
    let mut model = healthy.clone();
    let patch = patch(healthy);
    match code {
        Code::TangentNotFinite => set_tangents(&mut model, &patch, [f32::NAN, f32::NAN, f32::NAN, 1.0]),
        Code::PositionNotFinite => {
            patch.iter().step_by(3).for_each(|&at| model.positions[at] = [f32::NAN; 3])
        }
        Code::UvNotFinite => {
            let set = model.uv_set;
            patch.iter().step_by(3).for_each(|&vertex| model.uvs[set][vertex] = [f32::NAN; 2]);
        }
        Code::NormalNotFinite => {
            let normals = model.normals.as_mut()?;
            patch.iter().step_by(3).for_each(|&vertex| normals[vertex] = [f32::NAN; 3]);
        }
        Code::TangentZero => set_tangents(&mut model, &patch, [0.0, 0.0, 0.0, 1.0]),
        Code::TangentNotPerpendicular => lean(&mut model, &patch),
        Code::TangentSignMixed => {
            let odd = patch.iter().copied().filter(|vertex| vertex % 2 == 1).collect::<Vec<_>>();
            odd.into_iter().for_each(|vertex| model.tangents()[vertex][3] *= -1.0);
        }
        Code::TangentOtherUvSet => follow_other_set(&mut model),
        Code::NormalMissing => (model.normals, model.tangents) = (None, None),
        Code::NormalNotUnit => {
            let normals = model.normals.as_mut()?;
            patch.iter().for_each(|&vertex| normals[vertex] = [0.0; 3]);
        }
        Code::UvDegenerate => {
            let uv = model.uvs[model.uv_set][patch[0]];
            patch.iter().for_each(|&vertex| model.uvs[model.uv_set][vertex] = uv);
        }
        Code::MapRedFlipped => model.map = model.map.through(|[r, g, b]| [1.0 - r, g, b]),
        Code::MapNegativeZ => {
            let mut texels = model.map.texels.clone();
            let side = texels.len().isqrt();
            let is_speck = |i: usize| (i % side) % 40 < 12 && (i / side) % 40 < 12;
            (0..texels.len()).filter(|i| is_speck(*i)).for_each(|i| texels[i] = [150, 110, 40]);
            model.map = model.map.with_texels(texels);
        }
        Code::MapEnlarged => model.map = of_blocks(&model.map, 16, 1.0),
        Code::MapBlocks => model.map = of_blocks(&model.map, 16, 0.8),
        Code::MapBanding => model.map = model.map.through(|texel| texel.map(|x| (7.0 * x).round() / 7.0)),
        // What viewers show that go on without the image.
        Code::MapUnreadable => model.map = model.map.through(|_| [0.5, 0.5, 1.0]),
        _ => return None,
    }
    Some(model)
}

/// The map with its texels moved to the means of blocks, by a part of the way.
fn of_blocks(map: &Map, block: usize, part: f32) -> Map {
    let side = map.texels.len().isqrt();
    let texel = |i: usize| {
        let (left, top) = (i % side / block * block, i / side / block * block);
        let inside = (0..block * block).map(|k| map.texels[(top + k / block) * side + left + k % block]);
        let sums = inside.fold([0.0; 3], |sum, texel| [0, 1, 2].map(|c| sum[c] + f32::from(texel[c])));
        let mean = sums.map(|sum| sum / (block * block) as f32);
        [0, 1, 2].map(|c| ((1.0 - part) * f32::from(map.texels[i][c]) + part * mean[c]).round() as u8)
    };
    map.with_texels((0..map.texels.len()).map(texel).collect())
}

/// A drawing of a UV layout, as SVG, for what cannot be seen on a model; none for other codes. Mirrored
/// triangles are orange, and what lies below shows through.
pub fn shown_layout(code: Code) -> Option<String> {
    let beside = |[width, height]: [f32; 2]| {
        quads([30.0, 10.0], [80.0; 2]).chain(quads([130.0, 10.0], [width, height]))
    };
    let triangles: Vec<[[f32; 2]; 3]> = match code {
        Code::UvMirrored => {
            quads([10.0, 10.0], [80.0; 2]).chain(quads([190.0, 10.0], [-80.0, 80.0])).collect()
        }
        // The charts of the map are orange, and those of the mesh lie elsewhere.
        Code::MapOtherLayout => {
            quads([30.0, 10.0], [80.0; 2]).chain(quads([155.0, 40.0], [-80.0, 80.0])).collect()
        }
        Code::UvOverlapping => quads([30.0, 10.0], [80.0; 2]).chain(quads([75.0, 40.0], [80.0; 2])).collect(),
        // Faces of one size: those on the right are pressed together, or a small chart.
        Code::UvStretched => beside([12.0, 80.0]).collect(),
        Code::UvCoarse => beside([20.0; 2]).collect(),
        // One curved chart before and after.
        Code::UvRounded => {
            let chart = |left: f32, step: f32| {
                let on_grid = move |x: f32| (x / step).round() * step;
                let bent = move |[x, y]: [f32; 2]| {
                    let place = [left + 0.8 * x + 0.08 * y, y + 20.0 * (0.03 * x).sin()];
                    place.map(on_grid)
                };
                quads([0.0, 20.0], [90.0; 2]).map(move |corners| corners.map(bent))
            };
            chart(10.0, 0.01).chain(chart(105.0, 10.0)).collect()
        }
        // Charts that lie close together on black.
        Code::MapPadding => quads([8.0, 10.0], [80.0; 2])
            .chain(quads([91.0, 10.0], [60.0; 2]))
            .chain(quads([91.0, 73.0], [100.0, 57.0]))
            .collect(),
        Code::UvHardEdge => quads([60.0, 10.0], [80.0; 2]).collect(),
        _ => Vec::new(),
    };
    // The hard edge lies inside of a chart.
    let edge = match code {
        Code::UvHardEdge => "<path d=\"M100,10 V90\" stroke=\"#d00\" stroke-width=\"3\"/>\n",
        _ => "",
    };
    let ground = match code {
        Code::MapPadding => "<rect width=\"200\" height=\"140\" fill=\"#000\"/>\n",
        _ => "",
    };
    let shapes: String = triangles.iter().map(shape).collect();
    let head = "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 200 140\" width=\"220\" height=\"154\" stroke=\"#333\" stroke-width=\"0.6\">";
    (!triangles.is_empty()).then(|| format!("{head}\n{ground}{shapes}{edge}</svg>\n"))
}

/// The triangles of four by four quads beside a corner, with the signed width given; those of a negative
/// width are mirrored.
fn quads([left, top]: [f32; 2], [width, height]: [f32; 2]) -> impl Iterator<Item = [[f32; 2]; 3]> {
    let at = move |i: usize, j: usize| [left + 0.25 * width * i as f32, top + 0.25 * height * j as f32];
    (0..16).flat_map(move |quad| {
        let (i, j) = (quad % 4, quad / 4);
        [[at(i, j), at(i + 1, j), at(i + 1, j + 1)], [at(i, j), at(i + 1, j + 1), at(i, j + 1)]]
    })
}

fn shape([a, b, c]: &[[f32; 2]; 3]) -> String {
    let is_mirrored = (b[0] - a[0]) * (c[1] - a[1]) < (b[1] - a[1]) * (c[0] - a[0]);
    let colour = if is_mirrored { "#e80" } else { "#48c" };
    let points = [a, b, c].map(|[x, y]| format!("{x},{y}")).join(" ");
    format!("<polygon points=\"{points}\" fill=\"{colour}\" fill-opacity=\"0.45\"/>\n")
}

/// The vertices in a disc in the middle of the right half.
fn patch(model: &Model) -> Vec<usize> {
    let is_inside = |[x, y, _]: [f32; 3]| (x - 0.15).hypot(y - 0.1) < 0.22;
    (0..model.positions.len()).filter(|&vertex| is_inside(model.positions[vertex])).collect()
}

fn set_tangents(model: &mut Model, vertices: &[usize], tangent: [f32; 4]) {
    vertices.iter().for_each(|&vertex| model.tangents()[vertex] = tangent);
}

/// Leans tangents towards the normals by 60 degrees.
fn lean(model: &mut Model, vertices: &[usize]) {
    let normals = model.normals.clone().unwrap_or_default();
    for &vertex in vertices {
        let (tangent, normal) = (&mut model.tangents()[vertex], normals[vertex]);
        (0..3).for_each(|i| tangent[i] = 0.1 * tangent[i] + 0.995 * normal[i]);
    }
}

/// Gives the model a second UV set, turned by 80 degrees, and its tangents.
fn follow_other_set(model: &mut Model) {
    let (sin, cos) = 80.0f32.to_radians().sin_cos();
    model.uvs.push(model.uvs[0].iter().map(|[u, v]| [cos * u - sin * v, sin * u + cos * v]).collect());
    let computed = model.computed(Method::default(), 1);
    for (tangent, [x, y, z, _]) in model.tangents().iter_mut().zip(computed) {
        *tangent = [x, y, z, tangent[3]];
    }
}
