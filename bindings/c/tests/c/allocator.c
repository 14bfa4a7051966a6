/* Checks that all memory is allocated and freed with the caller's functions: on one thread, on several threads, and on the worker threads
 * of a context. */

#define _POSIX_C_SOURCE 200809L

#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "darboux.h"

typedef struct Counter {
  pthread_mutex_t lock;
  long taken;
  long bytes;
} Counter;

static void count(Counter *counter, long taken, long bytes) {
  pthread_mutex_lock(&counter->lock);
  counter->taken += taken;
  counter->bytes += bytes;
  pthread_mutex_unlock(&counter->lock);
}

static void *take(void *context, size_t size, size_t alignment) {
  Counter *counter = (Counter *)context;
  /* Space for the alignment, and for a pointer to the start of the allocation in front of the returned memory. */
  char *start = (char *)malloc(size + alignment + sizeof(char *));
  if (start == NULL) return NULL;
  uintptr_t at = ((uintptr_t)start + sizeof(char *) + alignment - 1) / alignment * alignment;
  memcpy((char *)at - sizeof(char *), &start, sizeof(char *));
  memset((char *)at, 0xa5, size);
  count(counter, 1, (long)size);
  return (void *)at;
}

static void give(void *context, void *memory, size_t size, size_t alignment) {
  char *start;
  (void)alignment;
  memcpy(&start, (char *)memory - sizeof(char *), sizeof(char *));
  free(start);
  count((Counter *)context, 0, -(long)size);
}

static void expect(int holds, const char *what) {
  if (holds) return;
  fprintf(stderr, "%s\n", what);
  exit(EXIT_FAILURE);
}

/* Large enough for a context to use its threads. */
enum { SIDE = 130, VERTICES = (SIDE + 1) * (SIDE + 1), CORNERS = 6 * SIDE * SIDE, THREADS = 4 };

static Counter counter = {PTHREAD_MUTEX_INITIALIZER, 0, 0};
static float positions[VERTICES][3], normals[VERTICES][3], uvs[VERTICES][2];
static uint32_t indices[CORNERS];
static float tangents[THREADS][CORNERS][4];

static darboux_mesh make_grid(void) {
  darboux_mesh mesh = {0};
  for (int v = 0; v < VERTICES; v++) {
    const int x = v % (SIDE + 1), y = v / (SIDE + 1);
    positions[v][0] = (float)x, positions[v][1] = (float)y, positions[v][2] = (float)(x * y % 7);
    uvs[v][0] = (float)(x * x), uvs[v][1] = (float)(y + x % 3);
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

static darboux_mesh mesh;

/* Creates and frees every object that owns memory. */
static void *use_everything(void *out) {
  float(*mine)[4] = (float(*)[4])out;
  darboux_vertex_split *split = NULL;
  darboux_plan *plan = NULL;
  darboux_mesh broken = mesh;
  expect(darboux_generate_tangents(&mesh, NULL, NULL, mine[0], CORNERS, 0, NULL) == DARBOUX_STATUS_OK, "no tangents");
  expect(darboux_split_vertices(&mesh, mine[0], CORNERS, 0, NULL, &split) == DARBOUX_STATUS_OK, "no split");
  expect(darboux_plan_create(&mesh, NULL, NULL, &plan) == DARBOUX_STATUS_OK, "no plan");
  expect(split->index_count == CORNERS, "wrong tangents");
  broken.index_count = CORNERS - 1;
  expect(darboux_generate_tangents(&broken, NULL, NULL, mine[0], CORNERS - 1, 0, NULL) == DARBOUX_STATUS_FACES, "not refused");
  expect(darboux_last_error()[0] != 0, "no message");
  darboux_vertex_split_free(split);
  darboux_plan_free(plan);
  return NULL;
}

int main(void) {
  pthread_t threads[THREADS];
  darboux_context *context = NULL;
  mesh = make_grid();
  expect(darboux_set_allocator(take, give, &counter) == DARBOUX_STATUS_OK, "the allocator was not taken");
  for (int i = 0; i < THREADS; i++) {
    expect(pthread_create(&threads[i], NULL, use_everything, tangents[i]) == 0, "no thread");
  }
  for (int i = 0; i < THREADS; i++) pthread_join(threads[i], NULL);
  expect(counter.taken > 0, "the allocator was not used");
  expect(counter.bytes == 0, "threads that ended have left memory");
  for (int i = 1; i < THREADS; i++) expect(memcmp(tangents[0], tangents[i], sizeof tangents[0]) == 0, "other tangents");

  expect(darboux_context_create(3, &context) == DARBOUX_STATUS_OK, "no context");
  memset(tangents[1], 0, sizeof tangents[1]);
  expect(darboux_generate_tangents(&mesh, NULL, context, tangents[1][0], CORNERS, 0, NULL) == DARBOUX_STATUS_OK, "no tangents");
  expect(memcmp(tangents[0], tangents[1], sizeof tangents[0]) == 0, "other tangents on a context's threads");
  darboux_context_free(context);
  expect(counter.bytes < 64 * 1024, "a context has left more than bookkeeping");

  expect(darboux_set_allocator(take, give, &counter) == DARBOUX_STATUS_TOO_LATE, "the allocator was taken twice");
  expect(strstr(darboux_last_error(), "before any other call") != NULL, "no message");
  return EXIT_SUCCESS;
}
