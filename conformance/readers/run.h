/* The main function of adapters in C and C++, for POSIX systems. Copy it with case.h. Licence: CC0. */
#ifndef CONFORMANCE_RUN_H
#define CONFORMANCE_RUN_H

#include <dirent.h>
#include <sys/stat.h>
#include <time.h>

#include "case.h"

/* Computes the tangents of a case, four numbers per corner, and returns NULL; or returns the reason for skipping the case. */
typedef const char *(*Compute)(const Case *c, float *tangents);

/* The repetitions of cases with many corners, of which the fastest counts, in processor time. */
enum { REPETITIONS = 5, MANY_CORNERS = 1000 };

static void run_case(Compute compute, const char *from, const char *to) {
    Case c = read_case(from);
    float *tangents = (float *)calloc(4 * c.corners + 1, sizeof *tangents);
    const char *skipped = NULL;
    clock_t least = 0;
    for (int round = 0; round < (c.corners > MANY_CORNERS ? REPETITIONS : 1); ++round) {
        clock_t start = clock();
        skipped = compute(&c, tangents);
        clock_t taken = clock() - start;
        least = round == 0 || taken < least ? taken : least;
    }
    if (skipped) {
        FILE *file = fopen(to, "wb");
        if (!file) { fprintf(stderr, "%s cannot be written\n", to); exit(1); }
        fprintf(file, "{\"skipped\": \"%s\"}\n", skipped);
        fclose(file);
    } else {
        write_result(to, tangents, c.corners, (double)least / CLOCKS_PER_SEC);
    }
    free(tangents);
    free(c.positions); free(c.normals); free(c.uvs); free(c.face_sizes); free(c.indices);
}

/* Runs an adapter `ADAPTER CASES RESULTS` on every case of a folder. The value is the exit code. */
static int run(int count, char **arguments, Compute compute) {
    DIR *cases = count == 3 ? opendir(arguments[1]) : NULL;
    if (!cases) { fprintf(stderr, "usage: %s CASES RESULTS\n", arguments[0]); return 2; }
    mkdir(arguments[2], 0777);
    for (struct dirent *entry; (entry = readdir(cases));) {
        if (!strstr(entry->d_name, ".json")) continue;
        char from[4200], to[4200];
        snprintf(from, sizeof from, "%s/%s", arguments[1], entry->d_name);
        snprintf(to, sizeof to, "%s/%s", arguments[2], entry->d_name);
        run_case(compute, from, to);
    }
    closedir(cases);
    return 0;
}

/* 1 if all faces are triangles. */
static inline int is_triangles(const Case *c) {
    for (size_t face = 0; face < c->faces; ++face)
        if (c->face_sizes[face] != 3) return 0;
    return 1;
}

/* The reason for skipping a case where only triangles and an angular threshold of 180 degrees are known, or NULL. */
static inline const char *not_plain(const Case *c) {
    if (!is_triangles(c)) return "triangles only";
    if (c->threshold != 180.0f) return "no angular threshold";
    return c->faces ? NULL : "no meshes without triangles";
}

/* The fourth number of a tangent: the sign of the bitangent along cross(normal, tangent). */
static inline float sign_of(const float *n, const float *t, const float *b) {
    float x = n[1] * t[2] - n[2] * t[1], y = n[2] * t[0] - n[0] * t[2], z = n[0] * t[1] - n[1] * t[0];
    return x * b[0] + y * b[1] + z * b[2] < 0.0f ? -1.0f : 1.0f;
}

#endif
