//! Draws the flag of the example and checks that the tangents of the plan change the picture.

mod common;
#[path = "../examples/flag.rs"]
#[allow(dead_code, reason = "a program")]
mod flag;

#[test]
fn a_flag_is_drawn() {
    for gpu in common::gpus() {
        let pixels = flag::paint(gpu).unwrap_or_else(|error| panic!("{error}"));
        let pixels: &[[u8; 4]] = pixels.as_chunks().0;
        let is_paper = |pixel: &[u8; 4]| *pixel == pixels[0];
        let cloth = pixels.iter().filter(|pixel| !is_paper(pixel)).count();
        assert!(cloth > pixels.len() / 4 && cloth < pixels.len() * 9 / 10, "{cloth} pixels of cloth");
        // The two rows differ in nothing but their tangents.
        let (above, below) = pixels.split_at(pixels.len() / 2);
        let other = above.iter().zip(below).filter(|(a, b)| a != b && !is_paper(a)).count();
        let outline = above.iter().zip(below).filter(|(a, b)| is_paper(a) != is_paper(b)).count();
        assert!(other > cloth / 8, "only {other} pixels are others without a plan");
        assert!(outline < 100, "{outline} pixels of paper are not");
    }
}
