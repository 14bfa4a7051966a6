//! [`Indices`]: ascending indices as runs.

/// Ascending indices, kept as runs: damage comes in runs, and a defect of every vertex is one.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Indices {
    /// The first index of each run, and the number of its indices.
    runs: Vec<[u32; 2]>,
    len: usize,
}

impl Indices {
    pub fn len(&self) -> usize {
        self.len
    }

    pub fn is_empty(&self) -> bool {
        self.len == 0
    }

    pub fn iter(&self) -> impl Iterator<Item = usize> {
        self.runs.iter().flat_map(|&[first, count]| first as usize..first as usize + count as usize)
    }

    /// The numbers at these indices, ascending as they are.
    pub fn numbered(&self, numbers: &[u32]) -> Self {
        self.iter().map(|index| numbers[index] as usize).collect::<Vec<_>>().as_slice().into()
    }

    /// The positions in `numbers`, which ascend, of the numbers that are among these indices.
    pub fn places_in(&self, numbers: &[u32]) -> Self {
        let places = numbers.iter().enumerate().filter(|(_, number)| self.contains(**number as usize));
        places.map(|(place, _)| place).collect::<Vec<_>>().as_slice().into()
    }

    pub fn contains(&self, index: usize) -> bool {
        let next = self.runs.partition_point(|[first, _]| *first as usize <= index);
        let run = next.checked_sub(1).map(|run| self.runs[run]);
        run.is_some_and(|[first, count]| index < first as usize + count as usize)
    }
}

impl From<&[usize]> for Indices {
    /// Runs of ascending indices, each below 2^32.
    fn from(indices: &[usize]) -> Self {
        let mut runs: Vec<[u32; 2]> = Vec::new();
        for &index in indices {
            match runs.last_mut() {
                Some([first, count]) if *first as usize + *count as usize == index => *count += 1,
                _ => runs.push([index as u32, 1]),
            }
        }
        Self { runs, len: indices.len() }
    }
}

/// What shows a defect.
#[derive(Clone, Copy, Debug)]
pub enum Items<'a> {
    Vertices(&'a Indices),
    Triangles(&'a Indices),
}

impl<'a> Items<'a> {
    pub fn indices(self) -> &'a Indices {
        match self {
            Self::Vertices(indices) | Self::Triangles(indices) => indices,
        }
    }
}

/// Some of all vertices or triangles of a surface.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Part {
    pub items: Indices,
    /// The number of all.
    pub of: usize,
}

impl Part {
    /// None without items.
    pub fn new(items: &[usize], of: usize) -> Option<Self> {
        (!items.is_empty()).then(|| Self { items: items.into(), of })
    }

    pub fn len(&self) -> usize {
        self.items.len()
    }

    pub fn percent(&self) -> f64 {
        100.0 * self.len() as f64 / self.of.max(1) as f64
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn indices_are_kept() {
        for indices in [&[][..], &[0], &[3, 4, 5, 9, 11, 12], &[7, 8]] {
            let kept = Indices::from(indices);
            assert_eq!(kept.iter().collect::<Vec<usize>>(), indices);
            assert_eq!(kept.len(), indices.len());
            assert!((0..20).all(|index| kept.contains(index) == indices.contains(&index)));
            let numbers: Vec<u32> = (0..20).map(|index| 3 * index).collect();
            let numbered = kept.numbered(&numbers);
            assert!((0..60).all(|number| numbered.contains(number) == (number % 3 == 0 && kept.contains(number / 3))));
            assert_eq!(numbered.places_in(&numbers), kept);
        }
    }
}
