layout(local_size_x = 64) in;

void main() {
    sample_ = gl_GlobalInvocationID.x;
    BODY
}
