// Computes the tangents of an engine's vertex buffer, and splits vertices: four triangles whose UVs are mirrored at x = 0.

#include <algorithm>
#include <cstdio>
#include <exception>
#include <vector>

#include "darboux.hpp"

struct Vertex {
  float position[3];
  float uv[2];
  float normal[3];
  float tangent[4];
};

static void run() {
  std::vector<Vertex> vertices = {
      {{-1, 0, 0}, {1, 0}, {0, 0, 1}, {}}, {{0, 0, 0}, {0, 0}, {0, 0, 1}, {}}, {{1, 0, 0}, {1, 0}, {0, 0, 1}, {}},
      {{-1, 1, 0}, {1, 1}, {0, 0, 1}, {}}, {{0, 1, 0}, {0, 1}, {0, 0, 1}, {}}, {{1, 1, 0}, {1, 1}, {0, 0, 1}, {}},
  };
  const std::vector<std::uint16_t> indices = {0, 1, 4, 0, 4, 3, 1, 2, 5, 1, 5, 4};

  darboux::mesh mesh;
  mesh.positions = darboux::field(vertices, &Vertex::position);
  mesh.normals = darboux::field(vertices, &Vertex::normal);
  mesh.uvs = darboux::field(vertices, &Vertex::uv);
  mesh.indices = indices;
  const auto tangents = darboux::generate_tangents(mesh);

  const auto split = darboux::split_vertices(mesh, tangents.corners);
  std::printf("%u vertices became %u\n", unsigned(vertices.size()), unsigned(split.vertex_count()));
  for (std::size_t v = 0; v < split.vertex_count(); v++) {
    Vertex vertex = vertices[split.source_of_vertex()[v]];
    std::copy_n(split.tangent_of_vertex()[v].data(), 4, vertex.tangent);
    std::printf("%g %g %g: tangent %g %g %g %g\n", vertex.position[0], vertex.position[1], vertex.position[2],
                vertex.tangent[0], vertex.tangent[1], vertex.tangent[2], vertex.tangent[3]);
  }
}

int main() {
  try {
    run();
    return 0;
  } catch (const std::exception &error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
