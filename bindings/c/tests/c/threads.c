/* Checks that only a context with several threads starts threads, that they end with it, and that results do not depend on them. */

#define _POSIX_C_SOURCE 200809L

#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "darboux.h"

enum { SIDE = 130, VERTICES = (SIDE + 1) * (SIDE + 1), CORNERS = 6 * SIDE * SIDE };

static float positions[VERTICES][3], normals[VERTICES][3], uvs[VERTICES][2];
static uint32_t indices[CORNERS];
static float alone[CORNERS][4], together[CORNERS][4];

static void expect(int holds, const char *what) {
  if (holds) return;
  fprintf(stderr, "%s\n", what);
  exit(EXIT_FAILURE);
}

static void check(darboux_status status) { expect(status == DARBOUX_STATUS_OK, darboux_last_error()); }

static int thread_count(void) {
  DIR *folder = opendir("/proc/self/task");
  int count = -2;
  expect(folder != NULL, "no /proc/self/task");
  while (readdir(folder) != NULL) count++;
  closedir(folder);
  return count;
}

static darboux_mesh make_grid(void) {
  darboux_mesh mesh = {0};
  for (int v = 0; v < VERTICES; v++) {
    const int x = v % (SIDE + 1), y = v / (SIDE + 1);
    const float position[3] = {(float)x, (float)y, (float)(x * y % 7)}, uv[2] = {(float)(x * x), (float)(y + x % 3)};
    memcpy(positions[v], position, sizeof position);
    memcpy(uvs[v], uv, sizeof uv);
    normals[v][2] = 1;
  }
  for (uint32_t square = 0, c = 0; square < SIDE * SIDE; square++) {
    const uint32_t a = square / SIDE * (SIDE + 1) + square % SIDE, d = a + SIDE + 1;
    const uint32_t corners[6] = {a, a + 1, d + 1, a, d + 1, d};
    for (int i = 0; i < 6; i++) indices[c++] = corners[i];
  }
  mesh.vertex_count = VERTICES;
  mesh.positions = positions[0];
  mesh.normals = normals[0];
  mesh.uvs = uvs[0];
  mesh.indices_u32 = indices;
  mesh.index_count = CORNERS;
  return mesh;
}

int main(void) {
  const darboux_mesh mesh = make_grid();
  darboux_context *context = NULL;
  darboux_plan *plan = NULL;
  check(darboux_generate_tangents(&mesh, NULL, NULL, alone[0], CORNERS, 0, NULL));
  check(darboux_plan_create(&mesh, NULL, NULL, &plan));
  check(darboux_plan_evaluate(plan, &mesh, NULL, together[0], CORNERS, 0));
  expect(memcmp(alone, together, sizeof alone) == 0, "the plan differs");
  check(darboux_context_create(1, &context));
  check(darboux_generate_tangents(&mesh, NULL, context, together[0], CORNERS, 0, NULL));
  darboux_context_free(context);
  expect(thread_count() == 1, "a thread was started");

  check(darboux_context_create(3, &context));
  expect(thread_count() == 4, "not three threads");
  for (int round = 0; round < 20; round++) {
    memset(together, 0, sizeof together);
    check(darboux_generate_tangents(&mesh, NULL, context, together[0], CORNERS, 0, NULL));
    expect(memcmp(alone, together, sizeof alone) == 0, "the number of threads shows");
    memset(together, 0, sizeof together);
    check(darboux_plan_evaluate(plan, &mesh, context, together[0], CORNERS, 0));
    expect(memcmp(alone, together, sizeof alone) == 0, "the number of threads shows in the plan");
  }
  darboux_context_free(context);
  expect(thread_count() == 1, "threads outlive their context");
  darboux_plan_free(plan);

  expect(darboux_context_create(100000, &context) == DARBOUX_STATUS_THREADS, "too many threads");
  check(darboux_context_create(0, &context));
  darboux_context_free(context);
  return EXIT_SUCCESS;
}
