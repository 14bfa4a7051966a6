//! The same bits for every number of threads.

use std::hash::{DefaultHasher, Hash, Hasher};

use darboux::internal::width_limit::{self, WidthLimit};
use darboux::{
    Choice, Context, Faces, Indices, Mesh, Method, MikkTSpaceOptions, Mode, Plan, TangentOptions,
    generate_frames, generate_tangents, generate_tangents_with,
};

/// A wavy grid of quads whose UVs are mirrored from one half to the other: vertices, and triangles in order.
fn grid(columns: u32, rows: u32) -> (Vec<[f32; 8]>, Vec<[u32; 3]>) {
    let vertex = |i: u32, j: u32| {
        let (x, y) = (i as f32 / columns as f32, j as f32 / rows as f32);
        let (dx, dy) = (0.6 * (6.0 * x).cos(), 0.5 * (5.0 * y).cos());
        let length = (dx * dx + dy * dy + 1.0).sqrt();
        let z = 0.1 * ((6.0 * x).sin() + (5.0 * y).sin());
        [x, y, z, -dx / length, -dy / length, 1.0 / length, (x - 0.5).abs(), y]
    };
    let vertices = (0..=rows).flat_map(|j| (0..=columns).map(move |i| vertex(i, j))).collect();
    let quad = |i: u32, j: u32| {
        let [a, d] = [j * (columns + 1) + i, (j + 1) * (columns + 1) + i];
        [[a, a + 1, d + 1], [a, d + 1, d]]
    };
    (vertices, (0..rows).flat_map(|j| (0..columns).flat_map(move |i| quad(i, j))).collect())
}

/// The modes of the fast path.
const MIKKTSPACE: [Method; 3] = [
    Method::MikkTSpace(MikkTSpaceOptions::new().with_mode(Mode::Reference)),
    Method::MikkTSpace(MikkTSpaceOptions::new().with_mode(Mode::Repaired)),
    Method::MikkTSpace(MikkTSpaceOptions::new().with_mode(Mode::Corrected)),
];

/// The methods other than MikkTSpace, which also run on several threads.
const SUMS: &[Method] = Method::ALL.split_at(1).1;

/// Vertices and faces of a mesh.
#[derive(Clone, Copy)]
struct Shape<'a> {
    vertices: &'a [[f32; 8]],
    corners: &'a [u32],
    faces: Faces<'a>,
}

/// Calls `take` with a mesh: indexed, with a vertex per corner, and unindexed.
fn for_each_layout(shape: &Shape<'_>, mut take: impl FnMut(&Mesh<'_>)) {
    let soup: Vec<[f32; 8]> = shape.corners.iter().map(|&vertex| shape.vertices[vertex as usize]).collect();
    let own: Vec<u32> = (0..soup.len() as u32).collect();
    let indexed = Indices::U32(shape.corners);
    for (vertices, indices) in
        [(shape.vertices, indexed), (&soup, Indices::U32(&own)), (&soup, Indices::Unindexed)]
    {
        let positions: Vec<[f32; 3]> = vertices.iter().map(|v| [v[0], v[1], v[2]]).collect();
        let normals: Vec<[f32; 3]> = vertices.iter().map(|v| [v[3], v[4], v[5]]).collect();
        let uvs: Vec<[f32; 2]> = vertices.iter().map(|v| [v[6], v[7]]).collect();
        take(&Mesh::with_faces(&positions, &normals, &uvs, indices, shape.faces).expect("a mesh"));
    }
}

/// The hash of the tangents and reports of some runs. Checks that plans give the same tangents.
fn hash(shape: &Shape<'_>, runs: &[Method]) -> u64 {
    hash_with(Context::new(), shape, runs)
}

fn hash_with(mut context: Context, shape: &Shape<'_>, runs: &[Method]) -> u64 {
    let mut hasher = DefaultHasher::new();
    for_each_layout(shape, |mesh| {
        for &method in runs {
            let options = TangentOptions::from(method);
            let tangents = generate_tangents_with(mesh, &options, &mut context).expect("not cancelled");
            let corners = tangents.corners.per_corner();
            corners.iter().for_each(|tangent| tangent.map(f32::to_bits).hash(&mut hasher));
            format!("{:?}", tangents.report).hash(&mut hasher);
            if options == TangentOptions::default() {
                let split = MikkTSpaceOptions::new().with_threshold(20.0).into();
                let of_split = generate_tangents(mesh, &split).corners;
                for (options, corners) in [(options, corners), (split, of_split.per_corner())] {
                    let planned = Plan::new(mesh, &options).evaluate(mesh).expect("the same mesh");
                    assert!(planned.per_corner() == corners);
                }
                of_split.per_corner().iter().for_each(|tangent| tangent.map(f32::to_bits).hash(&mut hasher));
            }
        }
    });
    hasher.finish()
}

/// The hash of whole frames.
fn hash_frames(shape: &Shape<'_>) -> u64 {
    let mut hasher = DefaultHasher::new();
    for_each_layout(shape, |mesh| {
        for frame in generate_frames(mesh, &TangentOptions::default()).corners.per_corner() {
            let [[x, y, z], [a, b, c], [m, n, s]] =
                [frame.tangent, frame.bitangent, [frame.magnitude[0], frame.magnitude[1], frame.sign]];
            [x, y, z, a, b, c, m, n, s].map(f32::to_bits).hash(&mut hasher);
        }
    });
    hasher.finish()
}

/// Checks that all thread counts give the same hash.
fn assert_alike(threads: &[usize], hash: impl Fn() -> u64 + Sync) {
    let hash = |&threads: &usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a thread pool");
        pool.install(&hash)
    };
    let hashes: Vec<u64> = threads.iter().map(hash).collect();
    assert!(hashes.iter().all(|hash| *hash == hashes[0]), "{threads:?}");
}

/// Joins pairs of triangles to quads: all of them, or all but every third.
fn quads(triangles: &[[u32; 3]], all: bool) -> (Vec<u32>, Vec<u32>) {
    let (mut corners, mut sizes) = (Vec::new(), Vec::new());
    for (at, pair) in triangles.as_chunks().0.iter().enumerate() {
        let [[a, b, c], [_, _, d]] = *pair;
        if all || at % 3 > 0 {
            corners.extend([a, b, c, d]);
            sizes.push(4);
        } else {
            corners.extend(pair.as_flattened());
            sizes.extend([3, 3]);
        }
    }
    (corners, sizes)
}

/// Gives every `step`th corner the vertex of the one before it, which makes some faces degenerate and leaves
/// holes.
fn damage(corners: &mut [u32], step: usize) {
    (1..corners.len()).step_by(step).for_each(|at| corners[at] = corners[at - 1]);
}

/// Threads that own no vertices: the end of the triangle list repeats its middle.
#[test]
fn parts_without_own_vertices() {
    let (vertices, mut triangles) = grid(200, 180);
    let rows = triangles[163 * 400..178 * 400].to_vec();
    triangles.extend(rows.iter().map(|&[a, b, c]| [a, c, b]));
    triangles.extend(rows);
    let corners = triangles.as_flattened();
    let shape = Shape { vertices: &vertices, corners, faces: Faces::Triangles };
    assert_alike(&[1, 4, 7, 8, 9], || hash(&shape, &MIKKTSPACE) ^ hash(&shape, SUMS));
}

/// Plans after the same context was used for a larger mesh, so that some worker threads have no part of this
/// mesh.
#[test]
fn plans_after_larger_meshes() {
    let ((large, in_order), (small, mut shuffled)) = (grid(300, 300), grid(150, 150));
    let triangles = shuffled.clone();
    (0..triangles.len()).for_each(|at| shuffled[at] = triangles[at * 7919 % triangles.len()]);
    let values = |vertices: &[[f32; 8]]| {
        let positions: Vec<[f32; 3]> = vertices.iter().map(|v| [v[0], v[1], v[2]]).collect();
        let normals: Vec<[f32; 3]> = vertices.iter().map(|v| [v[3], v[4], v[5]]).collect();
        (positions, normals, vertices.iter().map(|v| [v[6], v[7]]).collect::<Vec<[f32; 2]>>())
    };
    let (large, small) = (values(&large), values(&small));
    let large = Mesh::triangles(&large.0, &large.1, &large.2, Indices::U32(in_order.as_flattened())).unwrap();
    let small = Mesh::triangles(&small.0, &small.1, &small.2, Indices::U32(shuffled.as_flattened())).unwrap();
    let pool = rayon::ThreadPoolBuilder::new().num_threads(4).build().expect("a thread pool");
    pool.install(|| {
        let (options, mut context) = (TangentOptions::default(), Context::new());
        _ = generate_tangents_with(&large, &options, &mut context).expect("not cancelled");
        let plan = Plan::new(&small, &options);
        let mut corners = vec![[0.0; 4]; small.corner_count()];
        plan.write_tangents(&small, &mut context, &mut corners).expect("the same mesh");
        assert_eq!(corners, plan.base().corners.per_corner());
    });
}

const ONE_TWO_THREE_SIXTEEN: [usize; 4] = [1, 2, 3, 16];

/// Shuffles faces: a step that is coprime to their number visits each once.
fn shuffled<T: Copy>(faces: &[T]) -> Vec<T> {
    (0..faces.len()).map(|at| faces[at * 7919 % faces.len()]).collect()
}

#[test]
fn triangles() {
    let (vertices, triangles) = grid(300, 300);
    for triangles in [shuffled(&triangles), triangles] {
        let corners = triangles.as_flattened();
        let shape = Shape { vertices: &vertices, corners, faces: Faces::Triangles };
        assert_alike(&ONE_TWO_THREE_SIXTEEN, || hash(&shape, &MIKKTSPACE) ^ hash(&shape, SUMS));
        assert_alike(&ONE_TWO_THREE_SIXTEEN, || hash_frames(&shape));
    }
}

#[test]
fn faces_of_three_and_four_corners() {
    let (vertices, triangles) = grid(260, 260);
    let pairs: Vec<[[u32; 3]; 2]> = triangles.as_chunks().0.to_vec();
    for pairs in [shuffled(&pairs), pairs] {
        for all in [true, false] {
            let (corners, sizes) = quads(pairs.as_flattened(), all);
            let faces = if all { Faces::Quads } else { Faces::Mixed(&sizes) };
            let shape = Shape { vertices: &vertices, corners: &corners, faces };
            assert_alike(&ONE_TWO_THREE_SIXTEEN, || hash(&shape, &MIKKTSPACE));
            assert_alike(&ONE_TWO_THREE_SIXTEEN, || hash_frames(&shape));
        }
    }
}

#[test]
fn degenerate_faces() {
    let (vertices, triangles) = grid(200, 200);
    let mut of_triangles = triangles.as_flattened().to_vec();
    let (mut of_quads, _) = quads(&triangles, true);
    for (corners, faces) in [(&mut of_triangles, Faces::Triangles), (&mut of_quads, Faces::Quads)] {
        damage(corners, 997);
        let shape = Shape { vertices: &vertices, corners, faces };
        assert_alike(&ONE_TWO_THREE_SIXTEEN, || hash(&shape, &MIKKTSPACE));
        assert_alike(&ONE_TWO_THREE_SIXTEEN, || hash_frames(&shape));
    }
}

/// All vector widths that the machine has give one hash, with flaws in some blocks.
#[test]
fn every_width() {
    let (mut vertices, mut triangles) = grid(60, 60);
    (0..40).for_each(|at| vertices[at * 83][6] = [0.5, f32::NAN][at % 2]);
    (0..40).for_each(|at| vertices[at * 71][3..6].fill([0.0, 1e-12][at % 2]));
    (0..40).for_each(|at| triangles[at * 97][1] = triangles[at * 97][0]);
    let shape = Shape { vertices: &vertices, corners: triangles.as_flattened(), faces: Faces::Triangles };
    let hash = |width| hash_with(width_limit::context(width), &shape, SUMS);
    let compiled = hash(WidthLimit::Compiled);
    assert_eq!([WidthLimit::Bits256, WidthLimit::Bits512].map(hash), [compiled; 2]);
}
