/* Passes the meshes of standard input to genTangSpace, and writes the arguments of every setter call to standard output.
 *
 * Built with mikktspace.c and with libdarboux_mikktspace, the output must be equal. Each mesh: the number of faces, a bitmask of
 * the setters (1 basic, 2 full, 4: genTangSpaceDefault), the threshold, the size of each face, and 8 floats per corner: position,
 * normal, UV. Each result: the calls, the number -1, and the return value. */

#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "mikktspace.h"

typedef struct {
  int32_t faces;
  int32_t *sizes;
  /* The first corner of each face. */
  const float **corners;
} Mesh;

static const Mesh *mesh_of(const SMikkTSpaceContext *context) { return (const Mesh *)context->m_pUserData; }

/* The position of corner 0 of face 0 is requested even where face 0 has no corners. It is zero then. */
static void copy(const SMikkTSpaceContext *context, float out[], int face, int corner, int first, int count) {
  const Mesh *mesh = mesh_of(context);
  if (corner < mesh->sizes[face]) {
    memcpy(out, mesh->corners[face] + 8 * corner + first, sizeof(float) * (size_t)count);
  } else {
    memset(out, 0, sizeof(float) * (size_t)count);
  }
}

static int face_count(const SMikkTSpaceContext *context) { return mesh_of(context)->faces; }

static int face_size(const SMikkTSpaceContext *context, const int face) { return mesh_of(context)->sizes[face]; }

static void position(const SMikkTSpaceContext *context, float out[], const int face, const int corner) {
  copy(context, out, face, corner, 0, 3);
}

static void normal(const SMikkTSpaceContext *context, float out[], const int face, const int corner) {
  copy(context, out, face, corner, 3, 3);
}

static void uv(const SMikkTSpaceContext *context, float out[], const int face, const int corner) {
  copy(context, out, face, corner, 6, 2);
}

static void write_floats(const float *floats, int count) {
  for (int i = 0; i < count; i++) {
    /* The bits of a NaN differ between processors. */
    const uint32_t nan = 0x7fc00000;
    fwrite(floats[i] == floats[i] ? (const void *)&floats[i] : &nan, 4, 1, stdout);
  }
}

static void write_place(int32_t kind, int32_t face, int32_t corner) {
  const int32_t place[3] = {kind, face, corner};
  fwrite(place, sizeof place, 1, stdout);
}

static void set_basic(const SMikkTSpaceContext *context, const float tangent[], const float sign, const int face,
                      const int corner) {
  (void)context;
  write_place(1, face, corner);
  write_floats(tangent, 3);
  write_floats(&sign, 1);
}

static void set_full(const SMikkTSpaceContext *context, const float tangent[], const float bitangent[], const float s,
                     const float t, const tbool preserves, const int face, const int corner) {
  (void)context;
  write_place(2, face, corner);
  write_floats(tangent, 3);
  write_floats(bitangent, 3);
  write_floats(&s, 1);
  write_floats(&t, 1);
  write_place(preserves, 0, 0);
}

static void read_or_exit(void *to, size_t size) {
  if (fread(to, 1, size, stdin) != size) exit(EXIT_FAILURE);
}

static void *room(size_t count, size_t size) {
  void *memory = calloc(count + 1, size);
  if (memory == NULL) exit(EXIT_FAILURE);
  return memory;
}

static void run(int32_t faces) {
  int32_t setters;
  float threshold;
  read_or_exit(&setters, sizeof setters);
  read_or_exit(&threshold, sizeof threshold);
  const size_t count = faces > 0 ? (size_t)faces : 0;
  Mesh mesh = {faces, room(count, sizeof(int32_t)), room(count, sizeof(float *))};
  read_or_exit(mesh.sizes, count * sizeof(int32_t));
  size_t floats = 0;
  for (size_t face = 0; face < count; face++) floats += mesh.sizes[face] > 0 ? 8 * (size_t)mesh.sizes[face] : 0;
  float *corners = room(floats, sizeof(float));
  read_or_exit(corners, floats * sizeof(float));
  const float *at = corners;
  for (size_t face = 0; face < count; face++) {
    mesh.corners[face] = at;
    at += mesh.sizes[face] > 0 ? 8 * mesh.sizes[face] : 0;
  }

  SMikkTSpaceInterface callbacks = {face_count, face_size, position, normal, uv, NULL, NULL};
  if (setters & 1) callbacks.m_setTSpaceBasic = set_basic;
  if (setters & 2) callbacks.m_setTSpace = set_full;
  const SMikkTSpaceContext context = {&callbacks, &mesh};
  const tbool result = setters & 4 ? genTangSpaceDefault(&context) : genTangSpace(&context, threshold);
  write_place(-1, result, 0);
  free(mesh.sizes);
  free((void *)mesh.corners);
  free(corners);
}

int main(void) {
  int32_t faces;
  while (fread(&faces, sizeof faces, 1, stdin) == 1) run(faces);
  return EXIT_SUCCESS;
}
