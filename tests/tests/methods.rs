//! Every method except MikkTSpace, compared with the oracle in double precision, and on degenerate meshes.

use darboux::{
    Faces, Frame, Mesh, Method, Report, TangentOptions, generate_frames, generate_tangents, measure_tangents,
};
use darboux_tests::{Case, METHODS, OwnedMesh, families, oracle};

/// A method and its oracle.
type Twin = (Method, fn(&darboux::Mesh<'_>) -> Vec<Option<Frame>>);

const TWINS: [Twin; 8] = [
    (Method::AngleArea, oracle::angle_area),
    (Method::AngleEdge, oracle::angle_edge),
    (Method::Lengyel, oracle::lengyel),
    (Method::LengyelPerVertex, oracle::lengyel_per_vertex),
    (Method::Average, oracle::average),
    (Method::Area, oracle::area),
    (Method::Face, oracle::face),
    (Method::FromNormal, oracle::from_normal),
];

/// Rounding to f32 errs by 6e-8; a derivative is some ten roundings from its input, a sum over at most 16
/// triangles some 30 more, and the meshes' triangles are no thinner than 1 to 10, which multiplies the errors
/// of edges as much: 40 * 6e-8 * 10.
const TOLERANCE: f32 = 2.4e-5;

fn run(mesh: &OwnedMesh, method: Method) -> (Vec<Frame>, Report) {
    let frames = generate_frames(&mesh.view(), &method.into());
    (frames.corners.into_per_corner(), frames.report)
}

fn numbers(frame: &Frame) -> [f32; 8] {
    let ([a, b, c], [d, e, f], [g, h]) = (frame.tangent, frame.bitangent, frame.magnitude);
    [a, b, c, d, e, f, g, h]
}

/// The largest difference between two frames, relative for numbers above one.
fn difference(a: &Frame, b: &Frame) -> f32 {
    let pairs = numbers(a).into_iter().zip(numbers(b));
    pairs.map(|(a, b)| (a - b).abs() / b.abs().max(1.0)).fold((a.sign - b.sign).abs(), f32::max)
}

/// Regular meshes without degenerate triangles.
fn regular_meshes() -> Vec<(&'static str, OwnedMesh)> {
    let mut meshes = vec![
        ("sphere", families::sphere(8, 13, false)),
        ("fan", families::fan(16, false)),
        ("strip", families::strip(20)),
        ("unindexed grid", families::grid(6, 5, false, true).unindexed()),
    ];
    for quads in [false, true] {
        meshes.push(("grid", families::grid(9, 7, quads, false)));
        meshes.push(("mirrored grid", families::grid(8, 7, quads, true)));
        meshes.push(("cube", families::cube(quads)));
        meshes.push(("Möbius strip", families::moebius(9, quads)));
    }
    meshes
}

#[test]
fn all_agree_with_their_brute_force() {
    for (name, mesh) in regular_meshes() {
        for (method, twin) in TWINS {
            let (found, _) = run(&mesh, method);
            for (corner, (found, expected)) in found.iter().zip(twin(&mesh.view())).enumerate() {
                // At a mirrored seam the one sum per vertex cancels: what is left there is rounding.
                let Some(expected) = expected else { continue };
                if method == Method::LengyelPerVertex
                    && name.starts_with("mirrored")
                    && cancels(&mesh, corner)
                {
                    continue;
                }
                let worst = difference(found, &expected);
                assert!(
                    worst <= TOLERANCE,
                    "{method:?}, {name}, corner {corner}: {found:?} is not {expected:?} ({worst:e})"
                );
            }
        }
    }
}

/// True at the seam of the mirrored grid.
fn cancels(mesh: &OwnedMesh, corner: usize) -> bool {
    mesh.positions[mesh.vertex_of_corner(corner)][0] == 0.5
}

/// Checks the method's frames and its report.
fn check(mesh: &OwnedMesh, method: Method) -> Result<(), String> {
    let (frames, report) = run(mesh, method);
    if frames.len() != mesh.corner_count() {
        return Err(format!("{} frames", frames.len()));
    }
    for (corner, frame) in frames.iter().enumerate() {
        let normal = mesh.normals[mesh.vertex_of_corner(corner)];
        let wrong = |what: &str| Err(format!("corner {corner}: {what}: {frame:?}, normal {normal:?}"));
        let size = length(frame.tangent);
        if frame.sign.abs() != 1.0 {
            return wrong("the sign is not 1 or -1");
        }
        if !((size - 1.0).abs() < 1e-5 && (length(frame.bitangent) - 1.0).abs() < 1e-5) {
            return wrong("not of unit length");
        }
        // A face's frame lies in its own plane.
        if method != Method::Face
            && is_direction(normal)
            && dot(frame.tangent, normal).abs() > 1e-5 * length(normal)
        {
            return wrong("not perpendicular to the normal");
        }
    }
    let tangents = generate_tangents(&mesh.view(), &method.into());
    let same = tangents.corners.per_corner().iter().zip(&frames);
    if let Some(corner) =
        same.into_iter().position(|(a, b)| a.map(f32::to_bits) != b.tangent_and_sign().map(f32::to_bits))
    {
        return Err(format!("corner {corner}: generate_tangents and generate_frames differ"));
    }
    if tangents.report != report {
        return Err(format!("reports differ: {:?} and {report:?}", tangents.report));
    }
    check_report(mesh, method, &frames, &report)
}

fn check_report(mesh: &OwnedMesh, method: Method, frames: &[Frame], report: &Report) -> Result<(), String> {
    let mut tangents = vec![std::collections::HashSet::new(); mesh.positions.len()];
    for (corner, frame) in frames.iter().enumerate() {
        tangents[mesh.vertex_of_corner(corner)].insert(frame.tangent_and_sign().map(f32::to_bits));
    }
    let split = tangents.iter().filter(|tangents| tangents.len() > 1).count();
    let mut first = 0;
    let mut mixed = 0;
    for size in mesh.face_sizes().into_iter().map(|size| size as usize) {
        let signs = &frames[first..first + size];
        mixed += usize::from(matches!(size, 3 | 4) && signs.iter().any(|frame| frame.sign != signs[0].sign));
        first += size;
    }
    let expected = (split, mixed);
    let reported = (report.split_vertices, report.mixed_sign_faces);
    let merges = method == Method::LengyelPerVertex;
    if expected != reported || (merges && split > 0) || (!merges && mixed > 0) {
        return Err(format!("(split vertices, mixed faces): {expected:?}, reported {reported:?}"));
    }
    Ok(())
}

fn length(v: [f32; 3]) -> f64 {
    dot(v, v).sqrt()
}

fn dot(a: [f32; 3], b: [f32; 3]) -> f64 {
    (0..3).map(|i| f64::from(a[i]) * f64::from(b[i])).sum()
}

fn is_direction(v: [f32; 3]) -> bool {
    v.iter().all(|x| x.is_finite()) && v.iter().any(|x| x.abs() > f32::MIN_POSITIVE)
}

fn sweep(seeds: std::ops::Range<u64>) {
    for seed in seeds {
        let Case { mesh, .. } = Case::from_seed(seed);
        for (method, _) in TWINS {
            if let Err(broken) = check(&mesh, method) {
                panic!("{method:?}, seed {seed}: {broken}\n{}", mesh.to_text());
            }
        }
    }
}

#[test]
fn random_meshes() {
    sweep(0..10_000);
}

#[test]
#[ignore = "long"]
fn many_random_meshes() {
    sweep(10_000..300_000);
}

/// If dP/dv is along the normal, the bitangent is perpendicular to the fitted tangent.
#[test]
fn bitangents_without_a_direction_follow_the_fit() {
    let positions = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, 1.0f32]];
    let half = 0.5f32.sqrt();
    let normals = [[half, half, 0.0], [-0.6, 0.0, 0.8], [-0.6, 0.0, 0.8], [0.0, 0.0, 1.0f32]];
    let uvs = [[0.0, 0.0], [1.0, 1.0], [-1.0, 1.0], [0.0, 2.0f32]];
    let mesh = Mesh::triangles(&positions, &normals, &uvs, &[0u32, 1, 2, 1, 3, 2]).expect("a mesh");
    let options = TangentOptions::from(Method::AngleArea);
    let frame = generate_frames(&mesh, &options).corners.per_corner()[0];
    assert!(frame.tangent[2].abs() > 0.01, "the fit moved nothing: {frame:?}");
    assert!(dot(frame.bitangent, frame.tangent).abs() < 1e-6, "{frame:?}");
}

/// The corners of a triangle with NaN are counted; the triangle does not count as UV-degenerate.
#[test]
fn what_is_not_finite_is_not_uv_degenerate() {
    for method in METHODS.iter().copied().filter(|&method| method != Method::FromNormal) {
        let options = TangentOptions::from(method);
        let counts = |mesh: &OwnedMesh| {
            let report = generate_tangents(&mesh.view(), &options).report;
            [report.non_finite_corners, report.uv_degenerate_triangles, report.degenerate_triangles]
        };
        let mesh = families::grid(2, 2, false, false);
        let users = mesh.indices.as_ref().unwrap().iter().filter(|&&vertex| vertex == 4).count();
        let (mut with_position, mut with_uv, mut flat) = (mesh.clone(), mesh.clone(), mesh.clone());
        with_position.positions[4][0] = f32::NAN;
        with_uv.uvs[4][1] = f32::INFINITY;
        flat.uvs.fill([0.5; 2]);
        assert_eq!(counts(&mesh), [0, 0, 0], "{method:?}");
        assert_eq!(counts(&with_position), [users, 0, 0], "{method:?}");
        assert_eq!(counts(&with_uv), [users, 0, 0], "{method:?}");
        assert_eq!(counts(&flat), [0, 8, 0], "{method:?}");
    }
}

/// meshoptimizer's default weighting. Its arccosine errs by up to 5e-4, which moves the mean of a few
/// tangents by less than that times the angle between them.
#[test]
fn angle_edge_agrees_with_meshoptimizer() {
    const DEGREES: f64 = 0.1;
    let mut worst = 0.0f64;
    for (name, mesh) in regular_meshes() {
        let view = mesh.view();
        if !matches!(view.faces(), Faces::Triangles) {
            continue;
        }
        let ours = generate_tangents(&view, &Method::AngleEdge.into()).corners;
        let theirs = meshopt::generate_tangents(
            mesh.indices.as_deref(),
            &mesh.positions,
            &mesh.normals,
            &mesh.uvs,
            meshopt::TangentOptions::None,
        );
        let difference = measure_tangents(ours.per_corner(), &theirs).expect("the same mesh");
        assert_eq!((difference.sign_flips, difference.without_angle), (0, 0), "{name}");
        assert!(difference.max < DEGREES, "{name}: {} degrees", difference.max);
        worst = worst.max(difference.max);
    }
    println!("worst angle to meshoptimizer: {worst} degrees");
    assert!(worst > 0.0, "no mesh was compared, or the arccosine is exact");
}
