// What the stages of a run have in common.

struct Counts {
    // Vertices that only the core's own order can weld: values too large or not finite, equal ones with other signs of zeros; and
    // those that found no slot of the hash table in time.
    refused: atomic<u32>,
}

// No vertex, triangle or corner.
const NONE: u32 = 0xffffffffu;
