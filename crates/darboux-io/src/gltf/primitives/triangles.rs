//! Converts strips and fans to triangles.

/// How indices form triangles (glTF 2.0, 3.7.2.1).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum TriangleMode {
    /// Every three indices are a triangle.
    Triangles,
    /// Every index and the two after it are a triangle. Every second triangle is reversed.
    Strip,
    /// Every index after the first, the one after it, and the first are a triangle.
    Fan,
}

impl TriangleMode {
    /// The mode with this constant of glTF; none for points and lines.
    pub fn from_mode(mode: u32) -> Option<Self> {
        match mode {
            4 => Some(Self::Triangles),
            5 => Some(Self::Strip),
            6 => Some(Self::Fan),
            _ => None,
        }
    }

    /// The number of triangles of `length` indices.
    pub fn triangle_count(self, length: usize) -> usize {
        match self {
            Self::Triangles => length / 3,
            Self::Strip | Self::Fan => length.saturating_sub(2),
        }
    }

    /// The number of indices, of `length`, that belong to complete triangles.
    pub fn whole(self, length: usize) -> usize {
        match self {
            Self::Triangles => length - length % 3,
            Self::Strip | Self::Fan => length,
        }
    }

    /// The corners of the triangles, three per triangle.
    pub fn corners(self, indices: Vec<u32>) -> Vec<u32> {
        let windows = indices.windows(3);
        match self {
            Self::Triangles => indices,
            Self::Strip => {
                let numbered = windows.enumerate();
                numbered.flat_map(|(i, w)| [w[0], w[1 + i % 2], w[2 - i % 2]]).collect()
            }
            Self::Fan => windows.flat_map(|w| [w[1], w[2], indices[0]]).collect(),
        }
    }
}

/// The name of a mode in glTF; none if there is no such mode.
pub fn mode_name(mode: u32) -> Option<&'static str> {
    let names = ["POINTS", "LINES", "LINE_LOOP", "LINE_STRIP", "TRIANGLES", "TRIANGLE_STRIP", "TRIANGLE_FAN"];
    names.get(mode as usize).copied()
}

#[cfg(test)]
mod tests {
    use super::TriangleMode;

    #[test]
    fn strips_and_fans_wind_as_the_specification_says() {
        let list = vec![10, 11, 12, 13, 14];
        assert_eq!(TriangleMode::Strip.corners(list.clone()), [10, 11, 12, 11, 13, 12, 12, 13, 14]);
        assert_eq!(TriangleMode::Fan.corners(list), [11, 12, 10, 12, 13, 10, 13, 14, 10]);
    }

    #[test]
    fn too_few_indices_make_nothing() {
        assert_eq!(TriangleMode::Triangles.whole(5), 3);
        assert!(TriangleMode::Strip.corners(vec![0, 1]).is_empty());
        assert!(TriangleMode::Fan.corners(vec![0, 1]).is_empty());
        for topology in [TriangleMode::Triangles, TriangleMode::Strip, TriangleMode::Fan] {
            assert_eq!(topology.triangle_count(2), 0);
        }
    }
}
