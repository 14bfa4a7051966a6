//! Compares the plates that the CPU and GPUs draw.

use darboux_shader_tests::gpus;
use darboux_shader_tests::picture::{Encoding, draw_on_cpu, draw_on_gpu};

/// At most one channel in fifty differs, by one step, because interpolation and arithmetic differ only in
/// their last bits.
#[test]
fn plates_are_the_same_on_cpu_and_gpu() {
    for gpu in gpus() {
        for encoding in Encoding::ALL {
            let (right, drawn) = (draw_on_cpu(encoding), draw_on_gpu(gpu, encoding));
            let differences =
                || right.iter().flatten().zip(drawn.iter().flatten()).map(|(a, b)| a.abs_diff(*b));
            let (largest, count) = (differences().max(), differences().filter(|&d| d > 0).count());
            println!(
                "{encoding:?} on {}: {count} of {} channels differ, by up to {largest:?}",
                gpu.name,
                4 * right.len()
            );
            assert_eq!(right.len(), drawn.len());
            assert!(
                largest <= Some(1) && count < 4 * right.len() / 50,
                "{encoding:?}: {count} channels, by {largest:?}"
            );
        }
    }
}
