//! Union-find with path halving (R. Tarjan and J. van Leeuwen 1984).

/// Disjoint sets of the numbers below a count. A set is named by its smallest number.
#[derive(Clone, Debug)]
pub struct DisjointSets {
    parents: Vec<u32>,
}

impl DisjointSets {
    /// A set of one number for every number below `count`, which is at most 2^32.
    pub fn new(count: usize) -> Self {
        Self { parents: (0..count).map(|number| number as u32).collect() }
    }

    /// The name of the set that has a number.
    pub fn name(&mut self, mut number: usize) -> usize {
        while self.parents[number] as usize != number {
            self.parents[number] = self.parents[self.parents[number] as usize];
            number = self.parents[number] as usize;
        }
        number
    }

    /// Makes one set of the sets that have two numbers.
    pub fn join(&mut self, a: usize, b: usize) {
        let (a, b) = (self.name(a), self.name(b));
        self.parents[a.max(b)] = a.min(b) as u32;
    }

    /// The name of every number's set.
    pub fn into_names(mut self) -> Vec<u32> {
        (0..self.parents.len()).map(|number| self.name(number) as u32).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::DisjointSets;

    #[test]
    fn sets_are_named_by_their_smallest_number() {
        let mut sets = DisjointSets::new(7);
        for [a, b] in [[5, 6], [4, 5], [1, 3], [6, 3], [2, 2]] {
            sets.join(a, b);
        }
        assert_eq!(sets.into_names(), [0, 1, 2, 1, 1, 1, 1]);
    }
}
