//! Prints how generated normal maps are judged: `maps [COUNT] [LARGEST_SIDE] [SLOPE]`.
//!
//! Every map is judged as OpenGL's and as DirectX's, and every tenth one also as maps that are no gradient. SLOPE (default 1) makes all maps flatter: 0.03 gives maps of
//! about one code, on which the confidence is tested.

use darboux_tests::maps::table::{ConfusionTable, Truth};

fn main() {
    let mut arguments = std::env::args().skip(1).map(|argument| argument.parse::<f32>().ok());
    let mut next = |default: f32| arguments.next().flatten().unwrap_or(default);
    let (count, side, slope) = (next(2000.0), next(4096.0), next(1.0));
    let (count, side) = (count as u64, side as usize);
    let table = ConfusionTable::make(0..count, side, &Truth::ALL[..2], slope);
    let others = ConfusionTable::make(0..count / 10, side.min(512), &Truth::ALL[2..], slope);
    let table = table.joined(others);
    println!("{table}");
    for failure in &table.failures {
        println!("{failure}");
    }
}
