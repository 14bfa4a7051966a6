// Copies the tangent of each sum to its vertices or corners. One thread per vertex or corner.

// The sum, with the sign of w in the highest bit; NONE for unused vertices.
@group(0) @binding(1) var<storage, read> sum_of_output: array<u32>;
@group(0) @binding(2) var<storage, read> tangent_of_sum: array<u32>;
@group(0) @binding(3) var<storage, read_write> tangents: array<u32>;

@compute @workgroup_size(WORKGROUP)
fn write(@builtin(global_invocation_id) thread: vec3u, @builtin(num_workgroups) groups: vec3u) {
    let output = thread.x + thread.y * groups.x * WORKGROUP;
    if output >= plan.output_count || sum_of_output[output] == NONE {
        return;
    }
    let sum = sum_of_output[output] & 0x7fffffffu;
    let word = output * plan.tangent_stride + plan.tangent;
    tangents[word] = tangent_of_sum[4u * sum];
    tangents[word + 1u] = tangent_of_sum[4u * sum + 1u];
    tangents[word + 2u] = tangent_of_sum[4u * sum + 2u];
    tangents[word + 3u] = 0x3f800000u | (sum_of_output[output] & 0x80000000u);
}
