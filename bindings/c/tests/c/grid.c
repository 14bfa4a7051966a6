/* Times genTangSpaceDefault on a wavy grid of a million triangles, read through callbacks from indexed vertices, and prints nanoseconds
 * of processor time per triangle, minimum and median of the rounds, and a hash of the results: grid <rounds> <basic or full>. */

#define _POSIX_C_SOURCE 199309L

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "mikktspace.h"

enum { SIDE = 707, VERTICES = (SIDE + 1) * (SIDE + 1), TRIANGLES = 2 * SIDE * SIDE };

typedef struct Vertex {
  float position[3];
  float normal[3];
  float uv[2];
} Vertex;

static Vertex vertices[VERTICES];
static uint32_t indices[3 * TRIANGLES];
static float tangents[3 * TRIANGLES][4];

static void make_grid(void) {
  for (uint32_t v = 0; v < VERTICES; v++) {
    const float x = (float)(v % (SIDE + 1)) / SIDE, y = (float)(v / (SIDE + 1)) / SIDE;
    const float dx = 0.6f * cosf(6 * x), dy = 0.5f * cosf(5 * y), length = sqrtf(dx * dx + dy * dy + 1);
    const Vertex vertex = {{x, y, 0.1f * (sinf(6 * x) + sinf(5 * y))}, {-dx / length, -dy / length, 1 / length}, {x, y}};
    vertices[v] = vertex;
  }
  for (uint32_t t = 0; t < TRIANGLES; t++) {
    const uint32_t square = t / 2, a = square / SIDE * (SIDE + 1) + square % SIDE, d = a + SIDE + 1;
    const uint32_t corners[2][3] = {{a, a + 1, d + 1}, {a, d + 1, d}};
    memcpy(indices + 3 * t, corners[t % 2], sizeof corners[0]);
  }
}

static const Vertex *vertex(int face, int corner) { return &vertices[indices[3 * face + corner]]; }

static int face_count(const SMikkTSpaceContext *context) {
  (void)context;
  return TRIANGLES;
}

static int face_size(const SMikkTSpaceContext *context, const int face) {
  (void)context, (void)face;
  return 3;
}

static void position(const SMikkTSpaceContext *context, float out[], const int face, const int corner) {
  (void)context;
  memcpy(out, vertex(face, corner)->position, 3 * sizeof(float));
}

static void normal(const SMikkTSpaceContext *context, float out[], const int face, const int corner) {
  (void)context;
  memcpy(out, vertex(face, corner)->normal, 3 * sizeof(float));
}

static void uv(const SMikkTSpaceContext *context, float out[], const int face, const int corner) {
  (void)context;
  memcpy(out, vertex(face, corner)->uv, 2 * sizeof(float));
}

static void basic(const SMikkTSpaceContext *context, const float tangent[], const float sign, const int face, const int corner) {
  (void)context;
  memcpy(tangents[3 * face + corner], tangent, 3 * sizeof(float));
  tangents[3 * face + corner][3] = sign;
}

static void full(const SMikkTSpaceContext *context, const float tangent[], const float bitangent[], const float s, const float t,
                 const tbool preserves, const int face, const int corner) {
  (void)bitangent, (void)s, (void)t;
  basic(context, tangent, preserves ? 1.0f : -1.0f, face, corner);
}

static double now(void) {
  struct timespec time;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return (double)time.tv_sec * 1e9 + (double)time.tv_nsec;
}

static int compare(const void *a, const void *b) {
  const double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

int main(int count, char **arguments) {
  const int rounds = count > 1 ? atoi(arguments[1]) : 5;
  SMikkTSpaceInterface callbacks = {face_count, face_size, position, normal, uv, basic, NULL};
  const SMikkTSpaceContext context = {&callbacks, NULL};
  double *times = calloc((size_t)rounds + 1, sizeof *times);
  if (times == NULL || rounds < 1) return EXIT_FAILURE;
  if (count > 2 && strcmp(arguments[2], "full") == 0) callbacks.m_setTSpaceBasic = NULL, callbacks.m_setTSpace = full;
  make_grid();
  for (int round = 0; round < rounds; round++) {
    const double start = now();
    if (!genTangSpaceDefault(&context)) return EXIT_FAILURE;
    times[round] = (now() - start) / TRIANGLES;
  }
  qsort(times, (size_t)rounds, sizeof *times, compare);
  uint64_t hash = 14695981039346656037u;
  for (size_t i = 0; i < sizeof tangents; i++) hash = (hash ^ ((const unsigned char *)tangents)[i]) * 1099511628211u;
  printf("%.0f %.0f %016llx\n", times[0], times[rounds / 2], (unsigned long long)hash);
  free(times);
  return EXIT_SUCCESS;
}
