//! MikkTSpace compared with the oracle in double precision, on meshes where no decision depends on the last
//! bits.

use darboux::{Frame, MikkTSpaceOptions, Mode, TangentOptions, generate_frames};
use darboux_tests::{OwnedMesh, families, oracle};

/// Rounding to f32 errs by 6e-8; a derivative is some ten roundings from its input, a sum over at most 16
/// members some 30 more, and the meshes' triangles are no thinner than 1 to 10, which multiplies the errors
/// of edges as much: 40 * 6e-8 * 10.
const TOLERANCE: f32 = 2.4e-5;

fn assert_near(what: &str, mesh: &OwnedMesh, threshold: f32) {
    // The brute force matches every edge, as `Corrected` does; nothing here needs a repair.
    let options =
        TangentOptions::from(MikkTSpaceOptions::new().with_mode(Mode::Corrected).with_threshold(threshold));
    let found = generate_frames(&mesh.view(), &options).corners.into_per_corner();
    let expected = oracle::mikktspace(&mesh.view(), threshold);
    for (corner, (found, expected)) in found.iter().zip(&expected).enumerate() {
        let worst =
            numbers(found).into_iter().zip(numbers(expected)).map(|(a, b)| (a - b).abs() / b.abs().max(1.0));
        let worst = worst.fold(0.0, f32::max);
        let near = found.sign == expected.sign && worst <= TOLERANCE;
        assert!(
            near,
            "{what}, {threshold} degrees, corner {corner}: {found:?} is not {expected:?} ({worst:e})"
        );
    }
}

fn numbers(frame: &Frame) -> [f32; 8] {
    let ([a, b, c], [d, e, f], [g, h]) = (frame.tangent, frame.bitangent, frame.magnitude);
    [a, b, c, d, e, f, g, h]
}

#[test]
fn regular_meshes_at_every_threshold() {
    for threshold in [180.0, 100.0, 50.0, 20.0, 5.0] {
        for quads in [false, true] {
            for mirrored in [false, true] {
                assert_near("grid", &families::grid(9, 7, quads, mirrored), threshold);
            }
            assert_near("cube", &families::cube(quads), threshold);
            assert_near("Möbius strip", &families::moebius(9, quads), threshold);
        }
        // Triangles only, as the diagonals of its quads tie but for rounding; an odd number of segments, so
        // that none has an opposite one across the pole.
        assert_near("sphere", &families::sphere(8, 13, false), threshold);
        assert_near("fan", &families::fan(16, false), threshold);
        assert_near("strip", &families::strip(20), threshold);
        assert_near("unindexed grid", &families::grid(6, 5, false, true).unindexed(), threshold);
    }
}
