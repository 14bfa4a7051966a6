/* Computes one tangent per corner of two quads whose texture is mirrored at x = 0. Corners of one vertex can have different tangents. */

#include <stdio.h>

#include "darboux.h"

int main(void) {
  const float positions[6][3] = {{-1, 0, 0}, {0, 0, 0}, {1, 0, 0}, {-1, 1, 0}, {0, 1, 0}, {1, 1, 0}};
  const float normals[6][3] = {{0, 0, 1}, {0, 0, 1}, {0, 0, 1}, {0, 0, 1}, {0, 0, 1}, {0, 0, 1}};
  const float uvs[6][2] = {{1, 0}, {0, 0}, {1, 0}, {1, 1}, {0, 1}, {1, 1}};
  const uint32_t quads[8] = {0, 1, 4, 3, 1, 2, 5, 4};
  const darboux_mesh mesh = {.vertex_count = 6, .positions = positions[0], .normals = normals[0], .uvs = uvs[0],
                             .indices_u32 = quads, .index_count = 8, .faces = DARBOUX_FACES_QUADS};
  float tangents[8][4];
  if (darboux_generate_tangents(&mesh, NULL, NULL, tangents[0], 8, 0, NULL) != DARBOUX_STATUS_OK) return 1;
  for (int corner = 0; corner < 8; corner++) {
    const float *t = tangents[corner];
    printf("vertex %u: %g %g %g %g\n", (unsigned)quads[corner], t[0], t[1], t[2], t[3]);
  }
  return 0;
}
