//! A graph of files and the names that they import from each other, and its cycles.

use std::collections::{BTreeMap, BTreeSet, VecDeque};
use std::path::{Path, PathBuf};

/// At most this many names are printed per edge.
const NAMES_SHOWN: usize = 8;

/// For each file: the files that it imports from, and the names that it imports.
#[derive(Debug, Default, Clone)]
pub struct Graph {
    edges: BTreeMap<PathBuf, BTreeMap<PathBuf, BTreeSet<String>>>,
}

impl Graph {
    /// Adds an import of `name`. A file's use of its own names is ignored.
    pub fn add(&mut self, from: &Path, to: &Path, name: &str) {
        if from != to {
            let targets = self.edges.entry(from.to_path_buf()).or_default();
            targets.entry(to.to_path_buf()).or_default().insert(name.to_owned());
        }
    }

    /// Cycles as text, the shortest first. Removing one edge of each leaves a graph without cycles.
    ///
    /// After each cycle the edge with the fewest names is removed, and the search starts again.
    pub fn cycles(&self, file_name: &dyn Fn(&PathBuf) -> String) -> Vec<String> {
        let mut graph = self.clone();
        let mut chains = Vec::new();
        while let Some(cycle) = graph.shortest_cycle() {
            chains.push(graph.chain(&cycle, file_name));
            graph.remove_weakest_edge(&cycle);
        }
        chains
    }

    /// The files of the shortest cycle in order, each once.
    fn shortest_cycle(&self) -> Option<Vec<PathBuf>> {
        self.edges.keys().filter_map(|start| self.shortest_cycle_through(start)).min_by_key(Vec::len)
    }

    /// Breadth-first search from `start` until an edge leads back to it.
    fn shortest_cycle_through(&self, start: &PathBuf) -> Option<Vec<PathBuf>> {
        let mut previous: BTreeMap<&PathBuf, &PathBuf> = BTreeMap::new();
        let mut queue = VecDeque::from([start]);
        while let Some(file) = queue.pop_front() {
            for target in self.edges.get(file).into_iter().flat_map(BTreeMap::keys) {
                if target == start {
                    let mut cycle = vec![file.clone()];
                    while let Some(&before) = previous.get(cycle.last()?) {
                        cycle.push(before.clone());
                    }
                    cycle.reverse();
                    return Some(cycle);
                }
                if !previous.contains_key(target) {
                    previous.insert(target, file);
                    queue.push_back(target);
                }
            }
        }
        None
    }

    /// The edges of a cycle: each file and the one that it imports from.
    fn edges_of(cycle: &[PathBuf]) -> impl Iterator<Item = (&PathBuf, &PathBuf)> {
        cycle.iter().zip(cycle.iter().cycle().skip(1))
    }

    fn remove_weakest_edge(&mut self, cycle: &[PathBuf]) {
        let weakest = Self::edges_of(cycle).min_by_key(|(from, to)| self.edges[*from][*to].len());
        if let Some((from, to)) = weakest {
            self.edges.get_mut(from).and_then(|targets| targets.remove(to));
        }
    }

    /// `a.rs -> b.rs (names of b.rs) -> a.rs (names of a.rs)`.
    fn chain(&self, cycle: &[PathBuf], file_name: &dyn Fn(&PathBuf) -> String) -> String {
        let mut chain = file_name(&cycle[0]);
        for (from, to) in Self::edges_of(cycle) {
            let names = &self.edges[from][to];
            let mut shown: Vec<&str> = names.iter().take(NAMES_SHOWN).map(String::as_str).collect();
            if names.len() > NAMES_SHOWN {
                shown.push("...");
            }
            chain += &format!(" -> {} ({})", file_name(to), shown.join(", "));
        }
        chain
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn graph(edges: &[(&str, &str, &str)]) -> Graph {
        let mut graph = Graph::default();
        edges.iter().for_each(|(from, to, name)| graph.add(Path::new(from), Path::new(to), name));
        graph
    }

    fn cycles(edges: &[(&str, &str, &str)]) -> Vec<String> {
        graph(edges).cycles(&|file| file.display().to_string())
    }

    #[test]
    fn a_tree_has_no_cycle() {
        assert!(cycles(&[("a", "b", "B"), ("a", "c", "C"), ("b", "c", "C"), ("c", "c", "C")]).is_empty());
    }

    #[test]
    fn each_cycle_is_found_with_its_names() {
        let edges = [("a", "b", "B"), ("a", "b", "B2"), ("b", "a", "A"), ("b", "c", "C"), ("c", "a", "A")];
        assert_eq!(cycles(&edges), ["a -> b (B, B2) -> a (A)", "a -> b (B, B2) -> c (C) -> a (A)"]);
    }
}
