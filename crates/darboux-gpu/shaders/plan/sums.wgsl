// The sums of a plan, one per tangent, in one array: the end of each sum's range of members; the vertex whose normal it uses, with the flag
// IS_FORCED; the members, which are corners 3 t + k of triangles t.

@group(0) @binding(5) var<storage, read> sums: array<u32>;

// The sum has no members, and its tangent is to be replaced.
const IS_FORCED: u32 = 0x80000000u;

fn start_of_sum(sum: u32) -> u32 {
    if sum == 0u {
        return 0u;
    }
    return sums[sum - 1u];
}

fn member(place: u32) -> u32 {
    return sums[2u * plan.sum_count + place];
}

fn vertex_of_sum(sum: u32) -> u32 {
    return sums[plan.sum_count + sum];
}
