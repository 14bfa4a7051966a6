//! What a parallel machine needs: lists of triangles per vertex, and the layout of vertices in memory.

use super::drawing::{Figure, Side};
use super::plane::vec2;

/// The triangles of a mesh of five vertices.
const TRIANGLES: [[usize; 3]; 4] = [[0, 1, 2], [0, 2, 3], [0, 3, 4], [1, 4, 2]];
const VERTICES: usize = 5;

/// Adjacency lists: counts, their running sum, and the triangles of each vertex.
pub fn scatter_gather() -> Figure {
    let mut figure = Figure::new(
        720,
        330,
        "From scattering to gathering",
        "A list of four triangles is turned into adjacency lists: the number of triangles of each of five vertices, where each list starts, \
         which is the sum of all counts before it, and the triangles themselves in ascending order.",
    );
    let counts: Vec<usize> =
        (0..VERTICES).map(|vertex| TRIANGLES.iter().filter(|face| face.contains(&vertex)).count()).collect();
    let starts: Vec<usize> = (0..=VERTICES).map(|vertex| counts[..vertex].iter().sum()).collect();
    let lists: Vec<usize> = (0..VERTICES)
        .flat_map(|vertex| (0..TRIANGLES.len()).filter(move |&face| TRIANGLES[face].contains(&vertex)))
        .collect();
    let mut row = |top: f64, name: &str, values: &[usize], class: &dyn Fn(usize) -> &'static str| {
        figure.label(vec2(150.0, top + 15.0), name, "small", Side::Left);
        for (place, value) in values.iter().enumerate() {
            let at = vec2(166.0 + 40.0 * place as f64, top);
            figure.cell(at, vec2(40.0, 30.0), &format!("{} line", class(place)));
            figure.label(at + vec2(20.0, 15.0), &value.to_string(), "code small", Side::Centre);
        }
    };
    let triangles: Vec<usize> = TRIANGLES.into_iter().flatten().collect();
    let alternating = |number: usize| if number.is_multiple_of(2) { "face" } else { "other" };
    row(30.0, "indices", &triangles, &|corner| alternating(corner / 3));
    row(100.0, "count[vertex]", &counts, &alternating);
    row(160.0, "start[vertex]", &starts, &|vertex| {
        if vertex == VERTICES { "mirrored" } else { alternating(vertex) }
    });
    let vertex_at = |place: usize| starts.iter().filter(|&&start| start <= place).count() - 1;
    row(230.0, "triangles", &lists, &|place| alternating(vertex_at(place)));
    figure.label(vec2(420.0, 175.0), "start[v] = count[0] + … + count[v − 1]", "small", Side::Right);
    figure.label(vec2(380.0, 115.0), "triangles at each vertex", "small quiet", Side::Right);
    let words = [
        "vertex 2 reads triangles[start[2]] … triangles[start[3] − 1] and adds them in this order:",
        "no two threads write to one place, and every run gives the same bits",
    ];
    figure.lines(vec2(360.0, 286.0), &words, "small quiet", Side::Centre);
    figure
}

/// A member of a vertex structure and its number of floats.
type Member = (&'static str, usize);

/// The 56-byte vertex of many tutorials as a vertex buffer, and the same structure in a storage buffer under std430.
pub fn vertex_layout() -> Figure {
    let mut figure = Figure::new(
        720,
        270,
        "One structure, two layouts",
        "A vertex of position, normal, uv, tangent and bitangent takes 56 bytes in a vertex buffer. In a storage buffer under std430 each \
         vec3 begins at a multiple of 16 bytes, so that the same structure takes 80 bytes, 24 of them unused.",
    );
    let members: [Member; 5] = [("position", 3), ("normal", 3), ("uv", 2), ("tangent", 3), ("bitangent", 3)];
    let classes = ["face", "other", "mirrored", "face", "other"];
    let width = 8.2;
    for (top, title, is_aligned) in [(50.0, "vertex buffer", false), (160.0, "storage buffer, std430", true)]
    {
        let mut offset = 0;
        let mut offsets = Vec::new();
        for ((name, floats), class) in members.into_iter().zip(classes) {
            // std430: a vec2 is aligned to 8 bytes, a vec3 to 16.
            let alignment = if !is_aligned {
                4
            } else if floats == 2 {
                8
            } else {
                16
            };
            let start = usize::next_multiple_of(offset, alignment);
            figure.cell(
                vec2(30.0 + width * offset as f64, top),
                vec2(width * (start - offset) as f64, 40.0),
                "panel dashed",
            );
            let at = vec2(30.0 + width * start as f64, top);
            figure.cell(at, vec2(width * 4.0 * floats as f64, 40.0), &format!("{class} line"));
            figure.label(at + vec2(width * 2.0 * floats as f64, 20.0), name, "small", Side::Centre);
            offsets.push(start);
            offset = start + 4 * floats;
        }
        let size = if is_aligned { offset.next_multiple_of(16) } else { offset };
        figure.cell(
            vec2(30.0 + width * offset as f64, top),
            vec2(width * (size - offset) as f64, 40.0),
            "panel dashed",
        );
        for start in offsets {
            figure.label(
                vec2(30.0 + width * start as f64, top + 53.0),
                &start.to_string(),
                "code small quiet",
                Side::Centre,
            );
        }
        figure.label(vec2(30.0, top - 16.0), &format!("{title}: {size} bytes"), "", Side::Right);
    }
    figure.label(vec2(30.0, 246.0), "dashed: unused bytes", "small quiet", Side::Right);
    figure
}

/// Vertices, milliseconds of brute force, milliseconds of reading adjacency lists: measured on a software adapter (docs/learn/10-parallel.md).
const MEASURED: [(f64, f64, f64); 4] =
    [(121.0, 0.609, 0.086), (441.0, 7.335, 0.160), (1681.0, 209.437, 0.466), (5041.0, 2524.276, 1.251)];

/// The measured times of both ways, with logarithmic axes.
pub fn brute_force() -> Figure {
    let mut figure = Figure::new(
        720,
        330,
        "Brute force against adjacency lists",
        "Times over the number of vertices, both logarithmic. Brute force grows with the square, from 0.6 to 2524 milliseconds between 121 and 5041 vertices; \
         reading adjacency lists grows from 0.09 to 1.25 milliseconds.",
    );
    let at =
        |vertices: f64, ms: f64| vec2(90.0 + 270.0 * (vertices.log10() - 2.0), 210.0 - 48.0 * ms.log10());
    for (ms, words) in [(0.1, "0.1 ms"), (1.0, "1 ms"), (10.0, "10 ms"), (100.0, "100 ms"), (1000.0, "1 s")] {
        figure.line(at(100.0, ms), at(10_000.0, ms), "guide");
        figure.label(at(100.0, ms) + vec2(-10.0, 0.0), words, "small quiet", Side::Left);
    }
    for (name, class, value) in
        [("every vertex searches all triangles", "tangent", 1), ("every vertex reads its list", "normal", 2)]
    {
        let points =
            MEASURED.map(|(vertices, brute, lists)| at(vertices, if value == 1 { brute } else { lists }));
        figure.curve(&points, class);
        points.into_iter().for_each(|point| figure.point(point));
        let above = if value == 1 { vec2(-14.0, -14.0) } else { vec2(-14.0, 20.0) };
        figure.label(
            points[2] + above,
            name,
            &format!("small {class}"),
            if value == 1 { Side::Left } else { Side::Right },
        );
    }
    for (vertices, _, _) in MEASURED {
        figure.label(vec2(at(vertices, 1.0).x, 284.0), &format!("{vertices:.0}"), "small", Side::Centre);
    }
    figure.label(
        vec2(360.0, 308.0),
        "vertices, with about twice as many triangles",
        "small quiet",
        Side::Centre,
    );
    figure
}
