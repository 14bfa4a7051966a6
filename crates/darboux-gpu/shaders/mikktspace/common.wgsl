// Shared by the kernels of MikkTSpace and split.wgsl.

struct Counts {
    // The number of vertices that only the CPU can weld: values that are too large or not finite, or zeros of different signs in equal
    // vertices. Also counts probe sequences of a hash table that were too long.
    failure_count: atomic<u32>,
}

// No vertex, triangle or corner.
const NONE: u32 = 0xffffffffu;
