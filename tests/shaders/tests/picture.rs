//! Plates by the CPU and by GPUs.

use darboux_shader_tests::gpus;
use darboux_shader_tests::picture::{Encoding, draw_on_cpu, draw_on_gpu};

/// One channel in fifty at most, and by one step: interpolation and arithmetic differ in their last bits only.
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
