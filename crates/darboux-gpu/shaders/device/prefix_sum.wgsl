// Exclusive prefix sum in place (W. D. Hillis and G. L. Steele, "Data Parallel Algorithms", CACM 29(12), 1986).
//
//     scan       one workgroup per block: prefix sums within the block, and the sum of the block
//     (the sums of the blocks are scanned in the same way)
//     add_sums   adds to every value the sum of all blocks before its own

@group(0) @binding(0) var<storage, read_write> values: array<u32>;
@group(0) @binding(1) var<storage, read_write> sum_of_block: array<u32>;

var<workgroup> sums: array<u32, WORKGROUP>;

@compute @workgroup_size(WORKGROUP)
fn scan(
    @builtin(local_invocation_index) place: u32,
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) groups: vec3u,
) {
    let block = group.x + group.y * groups.x;
    let first = block * BLOCK + place * VALUES_PER_THREAD;
    let end = min(first + VALUES_PER_THREAD, arrayLength(&values));
    var own = 0u;
    for (var i = first; i < end; i++) {
        own += values[i];
    }
    sums[place] = own;
    workgroupBarrier();
    for (var step = 1u; step < WORKGROUP; step *= 2u) {
        var before = 0u;
        if place >= step {
            before = sums[place - step];
        }
        workgroupBarrier();
        sums[place] += before;
        workgroupBarrier();
    }
    var sum = sums[place] - own;
    for (var i = first; i < end; i++) {
        let value = values[i];
        values[i] = sum;
        sum += value;
    }
    if place == WORKGROUP - 1u && block < arrayLength(&sum_of_block) {
        sum_of_block[block] = sum;
    }
}

@compute @workgroup_size(WORKGROUP)
fn add_sums(@builtin(global_invocation_id) thread: vec3u, @builtin(num_workgroups) groups: vec3u) {
    let first = (thread.x + thread.y * groups.x * WORKGROUP) * VALUES_PER_THREAD;
    let end = min(first + VALUES_PER_THREAD, arrayLength(&values));
    for (var i = first; i < end; i++) {
        values[i] += sum_of_block[i / BLOCK];
    }
}
