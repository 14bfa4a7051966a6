#include <dirent.h>
#include <time.h>

#include "case.h"
#include "darboux.h"

static void compute(const char *from, const char *to) {
    Case c = read_case(from);
    float *tangents = calloc(4 * c.corners + 1, sizeof *tangents);
    darboux_mesh mesh = {0};
    mesh.vertex_count = c.vertices;
    mesh.positions = c.positions;
    mesh.position_stride = 12;
    mesh.normals = c.normals;
    mesh.normal_stride = 12;
    mesh.uvs = c.uvs;
    mesh.uv_stride = 8;
    mesh.indices_u32 = c.indices;
    mesh.index_count = c.corners;
    mesh.faces = DARBOUX_FACES_MIXED;
    mesh.face_sizes = c.face_sizes;
    mesh.face_count = c.faces;
    darboux_tangent_options options = {0};
    options.mode = DARBOUX_MODE_REFERENCE;
    options.threshold = c.threshold == 0.0f ? 0.001f : c.threshold; /* 0 stands for 180; 0.001 has the bits of zero */
    clock_t least = 0;
    for (int round = 0; round < 5; ++round) {
        clock_t start = clock();
        if (c.corners && darboux_generate_tangents(&mesh, &options, NULL, tangents, c.corners, 0, NULL)) {
            fprintf(stderr, "%s: darboux_generate_tangents failed\n", from);
            exit(1);
        }
        clock_t taken = clock() - start;
        least = round == 0 || taken < least ? taken : least;
    }
    write_result(to, tangents, c.corners, (double)least / CLOCKS_PER_SEC);
    free(tangents);
}

int main(int count, char **arguments) {
    DIR *cases = count == 3 ? opendir(arguments[1]) : NULL;
    if (!cases) return 2;
    char command[4200];
    snprintf(command, sizeof command, "mkdir -p '%s'", arguments[2]);
    if (system(command)) return 1;
    for (struct dirent *entry; (entry = readdir(cases));) {
        if (!strstr(entry->d_name, ".json")) continue;
        char from[4200], to[4200];
        snprintf(from, sizeof from, "%s/%s", arguments[1], entry->d_name);
        snprintf(to, sizeof to, "%s/%s", arguments[2], entry->d_name);
        compute(from, to);
    }
    return 0;
}
