/* A program written for mikktspace.c, which links libdarboux_mikktspace instead. */

#include <stdio.h>
#include <string.h>

#include "mikktspace.h"

typedef struct Vertex {
  float position[3];
  float uv[2];
  float normal[3];
  float tangent[4];
} Vertex;

static Vertex quad[4] = {
    {{0, 0, 0}, {0, 0}, {0, 0, 1}, {0}},
    {{1, 0, 0}, {1, 0}, {0, 0, 1}, {0}},
    {{1, 1, 0}, {1, 1}, {0, 0, 1}, {0}},
    {{0, 1, 0}, {0, 1}, {0, 0, 1}, {0}},
};

static Vertex *vertex(const SMikkTSpaceContext *context, int corner) { return (Vertex *)context->m_pUserData + corner; }

static int face_count(const SMikkTSpaceContext *context) {
  (void)context;
  return 1;
}

static int face_size(const SMikkTSpaceContext *context, const int face) {
  (void)context, (void)face;
  return 4;
}

static void position(const SMikkTSpaceContext *context, float out[], const int face, const int corner) {
  (void)face;
  memcpy(out, vertex(context, corner)->position, 3 * sizeof(float));
}

static void normal(const SMikkTSpaceContext *context, float out[], const int face, const int corner) {
  (void)face;
  memcpy(out, vertex(context, corner)->normal, 3 * sizeof(float));
}

static void uv(const SMikkTSpaceContext *context, float out[], const int face, const int corner) {
  (void)face;
  memcpy(out, vertex(context, corner)->uv, 2 * sizeof(float));
}

static void set_tangent(const SMikkTSpaceContext *context, const float tangent[], const float sign, const int face,
                        const int corner) {
  (void)face;
  memcpy(vertex(context, corner)->tangent, tangent, 3 * sizeof(float));
  vertex(context, corner)->tangent[3] = sign;
}

int main(void) {
  SMikkTSpaceInterface callbacks = {face_count, face_size, position, normal, uv, set_tangent, NULL};
  const SMikkTSpaceContext context = {&callbacks, quad};
  if (!genTangSpaceDefault(&context)) {
    fprintf(stderr, "no tangents\n");
    return 1;
  }
  for (int i = 0; i < 4; i++) {
    const float *tangent = quad[i].tangent;
    printf("%g %g %g %g\n", tangent[0], tangent[1], tangent[2], tangent[3]);
  }
  return 0;
}
