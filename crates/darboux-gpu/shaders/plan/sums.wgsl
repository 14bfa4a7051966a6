// A plan's sums in one list: where the members of each end, the vertex whose normal it has (with a mark), and the members, which are corners k
// of triangles t as 3 t + k.

@group(0) @binding(5) var<storage, read> sums: array<u32>;

// Nothing usable is to be had: a vertex without members whose tangent is to be replaced.
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
