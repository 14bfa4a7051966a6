// Computes one tangent per corner of two quads whose texture is mirrored at x = 0. Corners of one vertex can have different tangents.

#include <cstdio>

#include "darboux.hpp"

int main() {
  const float positions[6][3] = {{-1, 0, 0}, {0, 0, 0}, {1, 0, 0}, {-1, 1, 0}, {0, 1, 0}, {1, 1, 0}};
  const float normals[6][3] = {{0, 0, 1}, {0, 0, 1}, {0, 0, 1}, {0, 0, 1}, {0, 0, 1}, {0, 0, 1}};
  const float uvs[6][2] = {{1, 0}, {0, 0}, {1, 0}, {1, 1}, {0, 1}, {1, 1}};
  const std::uint32_t quads[8] = {0, 1, 4, 3, 1, 2, 5, 4};
  const darboux::mesh mesh = {positions, normals, uvs, quads, DARBOUX_FACES_QUADS};
  const auto tangents = darboux::generate_tangents(mesh).corners;
  for (std::size_t corner = 0; corner < tangents.size(); corner++) {
    const auto [x, y, z, w] = tangents[corner];
    std::printf("vertex %u: %g %g %g %g\n", unsigned(quads[corner]), x, y, z, w);
  }
}
