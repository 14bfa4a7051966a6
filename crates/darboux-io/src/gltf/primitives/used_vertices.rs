//! The vertices that corners use. Many primitives may share the vertices of one accessor, of which each uses
//! few: what is read of them takes time and memory in proportion to the corners.

/// Some vertices of accessors, and the place among them of every corner's vertex.
#[derive(Debug)]
pub struct UsedVertices {
    /// Ascending.
    pub vertices: Vec<u32>,
    /// Unspecified for vertices that the accessors do not have.
    pub of_corner: Vec<u32>,
}

/// Up to so many vertices per corner, a table of all vertices is faster than a search.
const MOST_IN_TABLE: usize = if cfg!(small_limits) { 2 } else { 16 };

impl UsedVertices {
    /// None where the accessors, which have `count` elements, have no more vertices than there are corners.
    pub fn of(corners: &[u32], count: usize) -> Option<Self> {
        if count <= corners.len() {
            return None;
        }
        Some(if count / MOST_IN_TABLE < corners.len() {
            Self::by_table(corners, count)
        } else {
            Self::by_search(corners)
        })
    }

    fn by_table(corners: &[u32], count: usize) -> Self {
        let mut places = vec![u32::MAX; count];
        for &vertex in corners {
            if let Some(place) = places.get_mut(vertex as usize) {
                *place = 0;
            }
        }
        let mut vertices = Vec::new();
        for (vertex, place) in places.iter_mut().enumerate().filter(|(_, place)| **place == 0) {
            *place = vertices.len() as u32;
            vertices.push(vertex as u32);
        }
        let place = |&vertex: &u32| places.get(vertex as usize).copied().unwrap_or(u32::MAX);
        let of_corner = corners.iter().map(place).collect();
        Self { vertices, of_corner }
    }

    fn by_search(corners: &[u32]) -> Self {
        let mut vertices = corners.to_vec();
        vertices.sort_unstable();
        vertices.dedup();
        let place = |vertex: &u32| vertices.partition_point(|used| used < vertex) as u32;
        let of_corner = corners.iter().map(place).collect();
        Self { vertices, of_corner }
    }
}

#[cfg(test)]
mod tests {
    use super::UsedVertices;

    #[test]
    fn places_name_the_vertices_of_corners() {
        let corners = [7, 3, 9, 3, 7, 8, 0];
        assert!(UsedVertices::of(&corners, 7).is_none());
        for used in [UsedVertices::by_table(&corners, 10), UsedVertices::by_search(&corners)] {
            assert_eq!(used.vertices, [0, 3, 7, 8, 9]);
            let named = used.of_corner.iter().map(|&place| used.vertices[place as usize]);
            assert_eq!(named.collect::<Vec<_>>(), corners);
        }
    }
}
