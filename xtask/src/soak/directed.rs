//! Cases that each try one kind of defect: names, memory, time, references, and limits of the system.

mod memory;
mod names;
mod process;
mod references;
mod time;
mod usage;

use super::case::Make;

/// A kind of case.
pub struct Directed {
    pub name: &'static str,
    pub make: Make,
    /// Whether the case draws pictures.
    pub renders: bool,
}

/// All of them, in an order that does not change.
pub fn all() -> Vec<Directed> {
    let lists: [(&[(&'static str, Make)], bool); 9] = [
        (names::CASES, false),
        (memory::CASES, false),
        (memory::OF_PICTURES, true),
        (time::CASES, false),
        (time::OF_PICTURES, true),
        (references::CASES, false),
        (process::CASES, false),
        (usage::CASES, false),
        (usage::OF_PICTURES, true),
    ];
    let all = lists
        .into_iter()
        .flat_map(|(list, renders)| list.iter().map(move |&(name, make)| Directed { name, make, renders }));
    all.collect()
}
