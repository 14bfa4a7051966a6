/* All memory comes from the caller's allocator, and goes back to it. */

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "darboux.h"

typedef struct Counter {
  long taken;
  long bytes;
} Counter;

static void *take(void *context, size_t size, size_t alignment) {
  Counter *counter = (Counter *)context;
  /* Room for the alignment and, before the memory, for where it began. */
  char *start = (char *)malloc(size + alignment + sizeof(char *));
  if (start == NULL) return NULL;
  uintptr_t at = ((uintptr_t)start + sizeof(char *) + alignment - 1) / alignment * alignment;
  memcpy((char *)at - sizeof(char *), &start, sizeof(char *));
  memset((char *)at, 0xa5, size);
  counter->taken++;
  counter->bytes += (long)size;
  return (void *)at;
}

static void give(void *context, void *memory, size_t size, size_t alignment) {
  char *start;
  (void)alignment;
  memcpy(&start, (char *)memory - sizeof(char *), sizeof(char *));
  free(start);
  ((Counter *)context)->bytes -= (long)size;
}

static void expect(int holds, const char *what) {
  if (holds) return;
  fprintf(stderr, "%s\n", what);
  exit(EXIT_FAILURE);
}

int main(void) {
  static Counter counter;
  static const float positions[4][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  static const float normals[4][3] = {{0, 0, 1}, {0, 0, 1}, {0, 0, 1}, {0, 0, 1}};
  static const float uvs[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  static const uint32_t indices[6] = {0, 1, 2, 0, 2, 3};
  darboux_mesh mesh = {0};
  darboux_vertex_split *split = NULL;
  darboux_plan *plan = NULL;
  float tangents[6][4];

  expect(darboux_set_allocator(take, give, &counter) == DARBOUX_STATUS_OK, "the allocator was not taken");
  mesh.vertex_count = 4;
  mesh.positions = positions[0];
  mesh.normals = normals[0];
  mesh.uvs = uvs[0];
  mesh.indices_u32 = indices;
  mesh.index_count = 6;
  expect(darboux_generate_tangents(&mesh, NULL, tangents[0], 6, 0, NULL) == DARBOUX_STATUS_OK, "no tangents");
  expect(darboux_split_vertices(&mesh, tangents[0], 6, 0, &split) == DARBOUX_STATUS_OK, "no split");
  expect(darboux_plan_create(&mesh, NULL, &plan) == DARBOUX_STATUS_OK, "no plan");
  expect(tangents[5][0] == 1 && split->vertex_count == 4 && split->indices[5] == 3, "wrong tangents");
  darboux_vertex_split_free(split);
  darboux_plan_free(plan);
  expect(counter.taken > 0, "the allocator was not used");
  expect(counter.bytes == 0, "memory was not given back");

  expect(darboux_set_allocator(take, give, &counter) == DARBOUX_STATUS_TOO_LATE, "the allocator was taken twice");
  expect(strstr(darboux_last_error(), "before any other call") != NULL, "no message");
  return EXIT_SUCCESS;
}
