//! The same bits for every number of threads.

use std::hash::{DefaultHasher, Hash, Hasher};

use darboux::{Indices, Mesh, Method, Mode, Plan, Scratch, TangentOptions, Tangents, generate_tangents_into};

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

/// What runs on several threads: the fast path, and the methods that sum.
const RUNS: [(Method, Mode); 8] = [
    (Method::MikkTSpace, Mode::Reference),
    (Method::MikkTSpace, Mode::Repaired),
    (Method::MikkTSpace, Mode::Corrected),
    (Method::Lengyel, Mode::Repaired),
    (Method::LengyelPerVertex, Mode::Reference),
    (Method::Average, Mode::Repaired),
    (Method::Area, Mode::Repaired),
    (Method::AngleArea, Mode::Repaired),
];

/// Hashes of the tangents and reports of a mesh, indexed, with a vertex per corner, and unindexed, in all runs.
fn hash(vertices: &[[f32; 8]], triangles: &[[u32; 3]]) -> u64 {
    let mut hasher = DefaultHasher::new();
    let mut scratch = Scratch::new();
    let mut tangents = Tangents::default();
    let soup: Vec<[f32; 8]> =
        triangles.as_flattened().iter().map(|&vertex| vertices[vertex as usize]).collect();
    let own: Vec<u32> = (0..soup.len() as u32).collect();
    let indexed = Indices::U32(triangles.as_flattened());
    for (vertices, indices) in [(vertices, indexed), (&soup, Indices::U32(&own)), (&soup, Indices::Unindexed)]
    {
        let positions: Vec<[f32; 3]> = vertices.iter().map(|v| [v[0], v[1], v[2]]).collect();
        let normals: Vec<[f32; 3]> = vertices.iter().map(|v| [v[3], v[4], v[5]]).collect();
        let uvs: Vec<[f32; 2]> = vertices.iter().map(|v| [v[6], v[7]]).collect();
        let mesh = Mesh::triangles(&positions, &normals, &uvs, indices).expect("a mesh");
        for (method, mode) in RUNS {
            let options = TangentOptions { method, mode, ..TangentOptions::default() };
            generate_tangents_into(&mesh, &options, &mut scratch, &mut tangents);
            let corners = tangents.corners.per_corner();
            corners.iter().for_each(|tangent| tangent.map(f32::to_bits).hash(&mut hasher));
            format!("{:?}", tangents.report).hash(&mut hasher);
        }
    }
    hasher.finish()
}

/// All thread counts give one hash.
fn assert_alike(vertices: &[[f32; 8]], triangles: &[[u32; 3]], threads: &[usize]) {
    let hash = |&threads: &usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a thread pool");
        pool.install(|| hash(vertices, triangles))
    };
    let hashes: Vec<u64> = threads.iter().map(hash).collect();
    assert!(hashes.iter().all(|hash| *hash == hashes[0]), "{threads:?}");
}

/// Threads whose triangles bring no vertices of their own: the end of the list repeats what is in its midst.
#[test]
fn parts_without_own_vertices() {
    let (vertices, mut triangles) = grid(200, 180);
    let rows = triangles[163 * 400..178 * 400].to_vec();
    triangles.extend(rows.iter().map(|&[a, b, c]| [a, c, b]));
    triangles.extend(rows);
    assert_alike(&vertices, &triangles, &[1, 4, 7, 8, 9]);
}

/// Plans on threads that worked on a larger mesh before, and have no part of this one.
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
        let (options, mut scratch) = (TangentOptions::default(), Scratch::new());
        let mut tangents = Tangents::default();
        generate_tangents_into(&large, &options, &mut scratch, &mut tangents);
        let plan = Plan::new(&small, &options);
        let mut corners = vec![[0.0; 4]; small.corner_count()];
        plan.write_tangents(&small, &mut scratch, &mut corners).expect("the same mesh");
        assert_eq!(corners, plan.base().corners.per_corner());
    });
}

#[test]
fn one_two_three_and_sixteen() {
    let (vertices, triangles) = grid(300, 300);
    let mut shuffled = triangles.clone();
    // A step without a common factor visits every triangle once.
    (0..triangles.len()).for_each(|at| shuffled[at] = triangles[at * 7919 % triangles.len()]);
    for triangles in [triangles, shuffled] {
        assert_alike(&vertices, &triangles, &[1, 2, 3, 16]);
    }
}
