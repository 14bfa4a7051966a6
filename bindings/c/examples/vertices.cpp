// Computes the tangents of an engine's vertex buffer, and splits vertices: four triangles whose UVs are mirrored at x = 0.

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
  std::vector<std::uint16_t> indices = {0, 1, 4, 0, 4, 3, 1, 2, 5, 1, 5, 4};

  const auto before = unsigned(vertices.size());
  darboux::add_tangents(vertices, &Vertex::position, &Vertex::normal, &Vertex::uv, indices, &Vertex::tangent);
  std::printf("%u vertices became %u\n", before, unsigned(vertices.size()));
  for (const Vertex &vertex : vertices) {
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
