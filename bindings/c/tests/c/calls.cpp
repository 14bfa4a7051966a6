// Calls every function of darboux.hpp on a mesh with known results.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>
#include <thread>
#include <type_traits>
#include <vector>

#include "darboux.hpp"

struct Vec3 {
  float x, y, z;
};

struct Vertex {
  Vec3 position;
  std::uint8_t colour[4];
  std::array<float, 2> uv;
  Vec3 normal;
  float tangent[4];
};

static void expect(bool holds, const char *what) {
  if (holds) return;
  std::fprintf(stderr, "%s\n", what);
  std::exit(1);
}

template <class Call>
static void expect_error(darboux_status status, const char *part, Call call) {
  try {
    call();
  } catch (const darboux::error &error) {
    expect(error.status() == status, error.what());
    expect(std::string(error.what()).find(part) != std::string::npos, error.what());
    return;
  }
  expect(false, part);
}

/// Six vertices and four triangles, with UVs mirrored at x = 0.
static std::vector<Vertex> make_vertices() {
  std::vector<Vertex> vertices(6);
  for (int v = 0; v < 6; v++) {
    const float x = float(v % 3) - 1, y = float(v / 3);
    vertices[std::size_t(v)] = {{x, y, 0}, {}, {std::fabs(x), y}, {0, 0, 1}, {}};
  }
  return vertices;
}

static const std::uint16_t INDICES[] = {0, 1, 4, 0, 4, 3, 1, 2, 5, 1, 5, 4};

static darboux::mesh make_mesh(const std::vector<Vertex> &vertices) {
  darboux::mesh mesh;
  mesh.positions = darboux::field(vertices, &Vertex::position);
  mesh.normals = darboux::field(vertices, &Vertex::normal);
  mesh.uvs = darboux::field(vertices, &Vertex::uv);
  mesh.indices = INDICES;
  return mesh;
}

static void tangents() {
  auto vertices = make_vertices();
  const auto mesh = make_mesh(vertices);
  const auto made = darboux::generate_tangents(mesh);
  expect(made.report.triangles == 4 && made.report.mirrored_edges == 1 && made.report.split_vertices == 2, "report");
  expect((made.corners[0] == darboux::tangent{-1, 0, 0, -1}) && (made.corners[7] == darboux::tangent{1, 0, 0, 1}), "tangents");

  const auto frames = darboux::generate_frames(mesh);
  expect(frames.corners[7].bitangent[1] == 1 && frames.corners[7].magnitude[0] == 1, "frames");

  const auto split = darboux::split_vertices(mesh, made.corners);
  expect(split.vertex_count() == 8 && split.source_of_vertex()[6] == 1 && split.indices().size() == 12, "split");
  expect((split.tangent_of_vertex()[7] == darboux::tangent{1, 0, 0, 1}), "tangent of a new vertex");

  darboux_tangent_options options = {};
  darboux::context context;
  options.method = DARBOUX_METHOD_FROM_NORMAL;
  for (int round = 0; round < 3; round++) {
    expect(darboux::generate_tangents(mesh, options, &context).corners.size() == 12, "with a context");
  }

  // Without indices, tangents are written into the vertices, between the attributes that the mesh reads.
  std::vector<Vertex> corners;
  for (auto index : INDICES) corners.push_back(vertices[index]);
  darboux::mesh soup = make_mesh(corners);
  soup.indices = {};
  darboux::generate_tangents(soup, darboux::field(corners, &Vertex::tangent));
  expect(corners[0].tangent[0] == -1 && corners[7].tangent[0] == 1 && corners[7].uv[0] == 1, "in place");
  const auto difference = darboux::measure_tangents(darboux::field(corners, &Vertex::tangent), made.corners);
  expect(difference.identical == 12 && difference.max == 0, "difference");
  expect(darboux::measure_uv_fidelity(mesh, made.corners).area == 2, "fidelity");
  const auto recipes = darboux::recognise_recipe(mesh, made.corners);
  expect(recipes.front().method == DARBOUX_METHOD_MIKKTSPACE && recipes.front().identical == recipes.front().corners, "recipe");
  const unsigned char texels[3 * 16] = {};
  expect(darboux::judge_normal_map(texels, 8, 3, 4, 4).texels == 16, "judgement");
}

static void faces() {
  const auto vertices = make_vertices();
  auto mesh = make_mesh(vertices);
  const std::vector<std::uint32_t> quads = {0, 1, 4, 3, 1, 2, 5, 4};
  mesh.indices = quads;
  mesh.faces = DARBOUX_FACES_QUADS;
  expect(darboux::generate_tangents(mesh).report.triangles == 4, "quads");
  const std::vector<std::uint32_t> mixed = {0, 1, 4, 3, 1, 2, 5}, sizes = {4, 3};
  mesh.indices = mixed;
  mesh.faces = DARBOUX_FACES_MIXED;
  mesh.face_sizes = sizes;
  expect(darboux::generate_tangents(mesh).report.triangles == 3, "mixed");
}

static void normals() {
  const auto vertices = make_vertices();
  darboux::mesh mesh;
  mesh.positions = darboux::field(vertices, &Vertex::position);
  mesh.indices = INDICES;
  const auto made = darboux::generate_normals(mesh);
  expect(made.report.faces == 4 && (made.corners[11] == darboux::normal{0, 0, 1}), "normals");
  expect(darboux::split_normals(mesh, made.corners).vertex_count() == 6, "split by normals");
}

/// The tangents, splits and indices of the functions called one by one.
static void added_tangents() {
  auto vertices = make_vertices();
  const auto mesh = make_mesh(vertices);
  const auto split = darboux::split_vertices(mesh, darboux::generate_tangents(mesh).corners);
  std::vector<std::array<std::uint32_t, 3>> triples(4);
  std::copy(std::begin(INDICES), std::end(INDICES), triples.front().data());
  std::vector<std::uint16_t> flat(std::begin(INDICES), std::end(INDICES));
  auto others = vertices;
  const auto add = [](auto &given, auto &indices) {
    return darboux::add_tangents(given, &Vertex::position, &Vertex::normal, &Vertex::uv, indices, &Vertex::tangent);
  };
  expect(add(vertices, triples).split_vertices == 2 && add(others, flat).triangles == 4, "report of added tangents");
  expect(vertices.size() == 8 && others.size() == 8, "added vertices");
  for (std::size_t v = 0; v < 8; v++) {
    const auto &source = vertices[split.source_of_vertex()[v]];
    expect(std::memcmp(vertices[v].tangent, split.tangent_of_vertex()[v].data(), 16) == 0, "tangents in vertices");
    expect(std::memcmp(&vertices[v].position, &source.position, 12) == 0 && std::memcmp(others[v].tangent, vertices[v].tangent, 16) == 0, "copies");
  }
  for (std::size_t corner = 0; corner < 12; corner++) {
    expect(triples[corner / 3][corner % 3] == split.indices()[corner] && flat[corner] == split.indices()[corner], "new indices");
  }
  std::vector<std::uint16_t> beyond = {0, 1, 9};
  expect_error(DARBOUX_STATUS_INDEX, "index 9 at place 2", [&] { add(vertices, beyond); });
  expect(vertices.size() == 8 && beyond[2] == 9, "nothing changed");
  // Every second triangle mirrors its UVs at vertex 0, and 65,536 vertices leave no room for a copy of it.
  vertices.resize(65536, vertices[0]);
  flat.assign(std::begin(INDICES), std::end(INDICES));
  for (auto &vertex : vertices) vertex.normal = {0, 0, 1};
  expect_error(DARBOUX_STATUS_TOO_LARGE, "use 32 bits", [&] { add(vertices, flat); });
  expect(vertices.size() == 65536 && std::equal(flat.begin(), flat.end(), std::begin(INDICES)), "nothing changed by too many");
}

static void skins() {
  struct Skinned {
    darboux::normal normal;
    std::uint16_t joints[2];
    std::array<float, 2> weights;
    float tangent[4];
  };
  const std::vector<std::array<float, 16>> bones = {{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}, {0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}};
  std::vector<Skinned> vertices(3, {{0, 0, 1}, {0, 1}, {1, 0}, {1, 0, 0, -1}});
  vertices[1].weights = {0, 1};
  vertices[2].weights = {0.5f, 0.5f};
  const auto skin = [&] {
    darboux::skin_frames(bones, {vertices, &Skinned::joints}, {vertices, &Skinned::weights}, darboux::field(vertices, &Skinned::normal),
                         darboux::field(vertices, &Skinned::tangent));
  };
  skin();
  expect(vertices[0].tangent[0] == 1 && vertices[1].tangent[1] == 1 && vertices[1].tangent[3] == -1, "skinned tangents");
  expect(std::fabs(vertices[2].tangent[0] - vertices[2].tangent[1]) < 1e-6f && vertices[2].normal[2] == 1, "blended");
  std::vector<darboux::normal> normals = {{0, 0, 1}};
  std::vector<darboux::tangent> tangents = {{1, 0, 0, 1}};
  const std::vector<std::array<std::uint16_t, 2>> joints = {{1, 0}};
  const std::vector<std::array<float, 2>> weights = {{1, 0}};
  darboux::skin_frames(bones, joints, weights, normals, tangents);
  expect((tangents[0] == darboux::tangent{0, 1, 0, 1}), "packed rows");
  vertices[1].joints[1] = 2;
  expect_error(DARBOUX_STATUS_INDEX, "joint 2", skin);
  expect_error(DARBOUX_STATUS_LENGTH, "as many as normals", [&] { darboux::skin_frames(bones, joints, weights, normals, {}); });
  const std::vector<std::array<float, 1>> one = {{1}};
  expect_error(DARBOUX_STATUS_LENGTH, "as many weights as joints", [&] { darboux::skin_frames(bones, joints, one, normals, tangents); });
}

static void plans() {
  auto vertices = make_vertices();
  const auto mesh = make_mesh(vertices);
  const darboux::plan plan(mesh);
  std::vector<darboux::tangent> base(12);
  expect(plan.base(base).triangles == 4, "base");
  for (auto &vertex : vertices) vertex.position.x *= 2;
  expect(plan.evaluate(mesh) == base && plan.count_regrouped(mesh) == 0, "evaluated");
}

template <darboux_tangent_encoding Encoding>
static void encoding() {
  const std::vector<darboux::tangent> tangents = {{0.6f, 0, 0.8f, -1}, {1, 0, 0, 1}};
  const std::vector<darboux::normal> normals = {{0.8f, 0, -0.6f}, {0, 0, 1}};
  const auto back = darboux::decode_tangents<Encoding>(darboux::encode_tangents<Encoding>(tangents, normals), normals);
  expect(darboux::measure_tangents(tangents, back).max < 0.4, "code");
  expect(back[0][3] == -1 && back[1][3] == 1, "sign of a code");
  expect(darboux::decode_tangents<Encoding>(darboux::encode_tangents<Encoding>({})).empty(), "no codes");
  expect_error(DARBOUX_STATUS_LENGTH, "as many as", [&] { darboux::encode_tangents<Encoding>(tangents, {normals.data()->data(), 1}); });
}

static void encodings() {
  encoding<DARBOUX_TANGENT_ENCODING_SNORM8>();
  encoding<DARBOUX_TANGENT_ENCODING_SNORM10>();
  encoding<DARBOUX_TANGENT_ENCODING_SNORM16>();
  encoding<DARBOUX_TANGENT_ENCODING_OCTAHEDRAL>();
  encoding<DARBOUX_TANGENT_ENCODING_DIAMOND>();
  const std::vector<darboux::tangent> tangents = {{0.6f, 0, 0.8f, -1}};
  const std::vector<darboux::normal> normals = {{0.8f, 0, -0.6f}};
  expect_error(DARBOUX_STATUS_NULL_POINTER, "normals", [&] { darboux::encode_tangents<DARBOUX_TANGENT_ENCODING_DIAMOND>(tangents); });
  std::vector<darboux::tangent> tangent_back(1);
  std::vector<darboux::normal> normal_back(1);
  darboux::decode_frames(darboux::encode_frames(normals, tangents), normal_back, tangent_back);
  expect(std::fabs(normal_back[0][2] + 0.6f) < 1e-3f && std::fabs(tangent_back[0][0] - 0.6f) < 1e-3f, "quaternion");
  normal_back = darboux::decode_normals(darboux::encode_normals(normals));
  expect(std::fabs(normal_back[0][0] - 0.8f) < 1e-3f, "octahedral normal");
  expect(darboux::decode_normals(darboux::encode_normals({})).empty(), "no normals");
}

static void conventions() {
  const auto gltf = darboux::convention_of(DARBOUX_PROGRAM_GLTF), unity = darboux::convention_of(DARBOUX_PROGRAM_UNITY);
  std::vector<darboux::tangent> tangents = {{1, 0, 0, 1}};
  darboux::conversion(darboux::generated(gltf), gltf).tangents(tangents);
  expect((tangents[0] == darboux::tangent{1, 0, 0, -1}), "glTF's sign");
  const darboux::conversion to_unity(gltf, unity);
  auto vertices = make_vertices();
  to_unity.vectors(darboux::field(vertices, &Vertex::position));
  to_unity.uvs(darboux::field(vertices, &Vertex::uv));
  expect(vertices[2].position.x == -1 && vertices[2].uv[0] == 1 && vertices[2].uv[1] == 1, "glTF to Unity");
  std::vector<std::uint32_t> indices = {0, 1, 4, 0, 4, 3};
  to_unity.faces(indices);
  expect((indices == std::vector<std::uint32_t>{0, 4, 1, 0, 3, 4}), "turned faces");
  const auto directx = darboux::convention_of(DARBOUX_PROGRAM_DIRECTX);
  expect((darboux::conversion(gltf, directx).channels() == std::array<bool, 2>{false, true}), "green down");

  std::vector<darboux::normal> normals = {{0, 0, 1}};
  const float orientation = darboux::transform_frames({-2, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 5, 5, 5, 1}, normals, tangents);
  expect(orientation == -1 && (tangents[0] == darboux::tangent{-1, 0, 0, 1}) && normals[0][2] == 1, "a mirror");
}

static void errors() {
  const auto vertices = make_vertices();
  auto mesh = make_mesh(vertices);
  std::vector<darboux::tangent> few(3);
  expect_error(DARBOUX_STATUS_LENGTH, "3 tangents", [&] { darboux::generate_tangents(mesh, few); });
  expect_error(DARBOUX_STATUS_LENGTH, "3 tangents", [&] { darboux::split_vertices(mesh, few); });
  mesh.normals = {};
  expect_error(DARBOUX_STATUS_NULL_POINTER, "normals is null", [&] { darboux::generate_tangents(mesh); });
  mesh = make_mesh(vertices);
  const std::vector<std::uint32_t> beyond = {0, 1, 6};
  mesh.indices = beyond;
  expect_error(DARBOUX_STATUS_INDEX, "index 6 at place 2", [&] { darboux::generate_tangents(mesh); });
  // A mesh with an empty index list has no faces. It is not an unindexed mesh.
  const std::vector<std::uint32_t> none;
  mesh.indices = none;
  expect(darboux::generate_tangents(mesh).corners.empty(), "an empty index list");
  darboux_tangent_options options = {};
  options.mode = darboux_mode(9);
  expect_error(DARBOUX_STATUS_UNKNOWN_VALUE, "9 is not a value of darboux_mode", [&] { darboux::generate_tangents(mesh, options); });
}

/// Every thread has its own error message.
static void threads() {
  std::vector<std::thread> running;
  for (std::uint32_t beyond = 6; beyond < 14; beyond++) {
    running.emplace_back([beyond] {
      const auto vertices = make_vertices();
      auto mesh = make_mesh(vertices);
      const std::vector<std::uint32_t> indices = {0, 1, beyond};
      for (int round = 0; round < 50; round++) {
        mesh.indices = indices;
        const std::string part = "index " + std::to_string(beyond) + " at";
        expect_error(DARBOUX_STATUS_INDEX, part.c_str(), [&] { darboux::generate_tangents(mesh); });
        mesh.indices = INDICES;
        expect(darboux::generate_tangents(mesh).corners[7][0] == 1, "in a thread");
      }
    });
  }
  for (auto &thread : running) thread.join();
}

static_assert(std::is_constructible_v<darboux::floats<1>, std::vector<float> &>, "floats");
static_assert(!std::is_constructible_v<darboux::floats<1>, std::vector<std::int32_t> &>, "integers are not floats");
static_assert(std::is_constructible_v<darboux::index_list, std::uint32_t (&)[2][3]>, "triples");
static_assert(!std::is_constructible_v<darboux::index_list, std::vector<std::array<std::uint32_t, 4>> &>, "quads are not triples");
static_assert(!std::is_constructible_v<darboux::index_list, std::vector<std::array<float, 3>> &>, "floats are not indices");
static_assert(!darboux::may_be_floats<std::uint32_t[3]> && darboux::may_be_floats<const float[3]>, "members");
static_assert(std::is_nothrow_move_constructible_v<darboux::plan> && !std::is_copy_constructible_v<darboux::plan>, "RAII");

int main() {
  try {
    tangents();
    faces();
    normals();
    added_tangents();
    skins();
    plans();
    encodings();
    conventions();
    errors();
    threads();
  } catch (const darboux::error &error) {
    expect(false, error.what());
  }
  return 0;
}
