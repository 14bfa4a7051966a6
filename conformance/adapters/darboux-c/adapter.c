#include "run.h"

#include "darboux.h"

static const char *compute(const Case *c, float *tangents) {
    darboux_mesh mesh = {0};
    mesh.vertex_count = c->vertices;
    mesh.positions = c->positions;
    mesh.position_stride = 12;
    mesh.normals = c->normals;
    mesh.normal_stride = 12;
    mesh.uvs = c->uvs;
    mesh.uv_stride = 8;
    mesh.indices_u32 = c->indices;
    mesh.index_count = c->corners;
    mesh.faces = DARBOUX_FACES_MIXED;
    mesh.face_sizes = c->face_sizes;
    mesh.face_count = c->faces;
    darboux_tangent_options options = {0};
    options.mode = DARBOUX_MODE_REFERENCE;
    options.threshold = c->threshold == 0.0f ? 0.001f : c->threshold; /* 0 stands for 180; 0.001 has the bits of zero */
    if (c->corners && darboux_generate_tangents(&mesh, &options, NULL, tangents, c->corners, 0, NULL)) {
        fprintf(stderr, "darboux_generate_tangents failed\n");
        exit(1);
    }
    return NULL;
}

int main(int count, char **arguments) { return run(count, arguments, compute); }
