/* Reads a case and writes a result, for adapters in C and C++. Copy it. The reader takes the numbers from the member "bits",
   whose hexadecimal words need no parsing of decimals. Licence: CC0. */
#ifndef CONFORMANCE_CASE_H
#define CONFORMANCE_CASE_H

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct {
    float threshold;                   /* degrees */
    size_t vertices, faces, corners;   /* counts */
    float *positions, *normals, *uvs;  /* 3, 3 and 2 numbers per vertex */
    uint32_t *face_sizes, *indices;    /* corners per face; vertex of each corner */
} Case;

/* The numbers of a JSON array, nested or not, that follows "key": words of eight hexadecimal digits, or integers. */
static uint32_t *case_array(const char *text, const char *key, size_t *count) {
    char quoted[64];
    snprintf(quoted, sizeof quoted, "\"%s\":", key);
    const char *at = strstr(text, quoted);
    uint32_t *out = NULL;
    size_t room = 0;
    int depth = 0;
    *count = 0;
    for (at = at ? at + strlen(quoted) : ""; *at; ++at) {
        char *end = NULL;
        if (*at == '[') { ++depth; continue; }
        if (*at == ']' && --depth == 0) break;
        if (*at != '"' && (*at < '0' || *at > '9')) continue;
        uint32_t value = (uint32_t)(*at == '"' ? strtoul(at + 1, &end, 16) : strtoul(at, &end, 10));
        if (*count == room) out = (uint32_t *)realloc(out, (room = room ? 2 * room : 64) * sizeof *out);
        if (!out) { fprintf(stderr, "out of memory\n"); exit(1); }
        out[(*count)++] = value;
        at = *at == '"' ? end : end - 1;
        if (depth == 0) break;
    }
    return out;
}

static Case read_case(const char *path) {
    FILE *file = fopen(path, "rb");
    if (!file) { fprintf(stderr, "%s cannot be read\n", path); exit(1); }
    fseek(file, 0, SEEK_END);
    size_t size = (size_t)ftell(file), count;
    char *text = (char *)calloc(size + 1, 1);
    rewind(file);
    if (!text || fread(text, 1, size, file) != size) { fprintf(stderr, "%s cannot be read\n", path); exit(1); }
    fclose(file);
    const char *bits = strstr(text, "\"bits\":");
    if (!bits) { fprintf(stderr, "%s has no bits; make large cases with generate.py\n", path); exit(1); }
    Case c;
    uint32_t *threshold = case_array(bits, "threshold", &count);
    memcpy(&c.threshold, threshold, 4);
    free(threshold);
    c.positions = (float *)case_array(bits, "positions", &count);
    c.vertices = count / 3;
    c.normals = (float *)case_array(bits, "normals", &count);
    c.uvs = (float *)case_array(bits, "uvs", &count);
    c.face_sizes = case_array(text, "faces", &c.faces);
    c.indices = case_array(text, "indices", &c.corners);
    free(text);
    return c;
}

/* Writes tangents, four numbers per corner, and the seconds that the computation took. */
static void write_result(const char *path, const float *tangents, size_t corners, double seconds) {
    FILE *file = fopen(path, "wb");
    if (!file) { fprintf(stderr, "%s cannot be written\n", path); exit(1); }
    fprintf(file, "{\"seconds\": %.9f, \"tangents\": [", seconds);
    for (size_t i = 0; i < 4 * corners; ++i) {
        float x = tangents[i];
        fprintf(file, i == 0 ? "[" : i % 4 ? ", " : "],\n[");
        if (isfinite(x)) fprintf(file, "%.9g", x);
        else fprintf(file, isnan(x) ? "\"nan\"" : x > 0 ? "\"inf\"" : "\"-inf\"");
    }
    fprintf(file, corners ? "]]}\n" : "]}\n");
    fclose(file);
}

#endif
