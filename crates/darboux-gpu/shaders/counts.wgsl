// What a run of all stages counts.

struct Counts {
    // Vertices that only the core's own order can weld: values too large or not finite, equal ones with other signs of zeros; and
    // those that found no slot of the hash table in time.
    refused: atomic<u32>,
    // Vertices that are copies of another.
    copies: atomic<u32>,
    // Triangles with two equal positions.
    degenerate: atomic<u32>,
    // Triangles whose UVs span no area.
    uv_degenerate: atomic<u32>,
    // Edges between triangles of opposite orientation.
    mirrored_edges: atomic<u32>,
    groups: atomic<u32>,
}

const NONE: u32 = 0xffffffffu;
