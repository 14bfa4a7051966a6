/* Computes the tangents of an engine's vertex buffer, and splits vertices: four triangles whose UVs are mirrored at x = 0. */

#include <stdio.h>
#include <stdlib.h>

#include "darboux.h"

typedef struct Vertex {
  float position[3];
  float uv[2];
  float normal[3];
  float tangent[4];
} Vertex;

static const Vertex vertices[6] = {
    {{-1, 0, 0}, {1, 0}, {0, 0, 1}, {0}}, {{0, 0, 0}, {0, 0}, {0, 0, 1}, {0}}, {{1, 0, 0}, {1, 0}, {0, 0, 1}, {0}},
    {{-1, 1, 0}, {1, 1}, {0, 0, 1}, {0}}, {{0, 1, 0}, {0, 1}, {0, 0, 1}, {0}}, {{1, 1, 0}, {1, 1}, {0, 0, 1}, {0}},
};
static const uint16_t indices[12] = {0, 1, 4, 0, 4, 3, 1, 2, 5, 1, 5, 4};

static void check(darboux_status status) {
  if (status != DARBOUX_STATUS_OK) {
    fprintf(stderr, "%s\n", darboux_last_error());
    exit(EXIT_FAILURE);
  }
}

int main(void) {
  const darboux_mesh mesh = {
      .size = sizeof mesh,
      .vertex_count = 6,
      .positions = vertices[0].position,
      .position_stride = sizeof(Vertex),
      .normals = vertices[0].normal,
      .normal_stride = sizeof(Vertex),
      .uvs = vertices[0].uv,
      .uv_stride = sizeof(Vertex),
      .indices_u16 = indices,
      .index_count = 12,
  };
  float tangents[12][4];
  check(darboux_generate_tangents(&mesh, NULL, NULL, tangents[0], 12, 0, NULL));

  darboux_vertex_split *split = NULL;
  check(darboux_split_vertices(&mesh, tangents[0], 12, 0, NULL, &split));
  printf("6 vertices became %u\n", (unsigned)split->vertex_count);
  for (size_t v = 0; v < split->vertex_count; v++) {
    Vertex vertex = vertices[split->source_of_vertex[v]];
    for (int i = 0; i < 4; i++) vertex.tangent[i] = split->tangent_of_vertex[v][i];
    printf("%g %g %g: tangent %g %g %g %g\n", vertex.position[0], vertex.position[1], vertex.position[2],
           vertex.tangent[0], vertex.tangent[1], vertex.tangent[2], vertex.tangent[3]);
  }
  darboux_vertex_split_free(split);
  return EXIT_SUCCESS;
}
