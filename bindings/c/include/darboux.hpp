// Darboux for C++17: a wrapper of darboux.h with array views that carry their size, objects that free themselves, and exceptions.
//
// MIT or Apache-2.0, as you choose. Functions have the names of darboux.h, where they are documented; comments here give the differences.
// Output arrays come before options and contexts, because these have defaults.
// Every function can throw darboux::error; functions that return a vector can throw std::bad_alloc.

#ifndef DARBOUX_HPP
#define DARBOUX_HPP

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <iterator>
#include <limits>
#include <memory>
#include <stdexcept>
#include <type_traits>
#include <utility>
#include <vector>

#include "darboux.h"

namespace darboux {

/// A view of contiguous elements. It converts to std::span implicitly in C++20. The type is the same in C++17 and C++20, so that parts of
/// one program may be compiled for different standards.
template <class T>
class span {
 public:
  constexpr span() = default;
  constexpr span(T *data, std::size_t size) : data_(data), size_(size) {}
  template <class Container, class = std::enable_if_t<
                                 std::is_convertible_v<decltype(std::data(std::declval<Container &>())), T *>>>
  constexpr span(Container &&elements) : data_(std::data(elements)), size_(std::size(elements)) {}

  constexpr T *data() const { return data_; }
  constexpr std::size_t size() const { return size_; }
  constexpr bool empty() const { return size_ == 0; }
  constexpr T *begin() const { return data_; }
  constexpr T *end() const { return data_ + size_; }
  constexpr T &operator[](std::size_t at) const { return data_[at]; }

 private:
  T *data_ = nullptr;
  std::size_t size_ = 0;
};

/// A tangent: unit xyz and the sign w, where bitangent = w * cross(normal, xyz).
using tangent = std::array<float, 4>;
/// A normal: unit xyz.
using normal = std::array<float, 3>;

/// The exception of a failed call: its status, and the message of darboux_last_error as what().
class error : public std::runtime_error {
 public:
  error(darboux_status status, const char *message) : std::runtime_error(message), status_(status) {}
  darboux_status status() const noexcept { return status_; }

 private:
  darboux_status status_;
};

/// Throws darboux::error unless `status` is DARBOUX_STATUS_OK. For direct calls of darboux.h, on the same thread.
inline void check(darboux_status status) {
  if (status != DARBOUX_STATUS_OK) throw error(status, darboux_last_error());
}

/// False for numbers and enumerations other than float, and for arrays of them. True for every class, because its members are not known.
template <class T, class Scalar = std::remove_cv_t<std::remove_all_extents_t<T>>>
inline constexpr bool may_be_floats = std::is_same_v<Scalar, float> || !(std::is_arithmetic_v<Scalar> || std::is_enum_v<Scalar>);

/// A strided view of elements of `N` floats. `Float`: `const float` for inputs, `float` for outputs.
template <class Float, std::size_t N>
class strided {
 public:
  constexpr strided() = default;

  /// `size` elements, the first at `data`, `stride` bytes apart.
  constexpr strided(Float *data, std::size_t size, std::size_t stride = N * sizeof(float))
      : data_(data), size_(size), stride_(stride) {}

  /// A contiguous container of any type of the size of `N` floats: std::array<float, N>, or an engine's vector type.
  template <class Container, class Element = std::remove_pointer_t<decltype(std::data(std::declval<Container &>()))>,
            class = std::enable_if_t<sizeof(Element) == N * sizeof(float) && may_be_floats<Element> &&
                                     std::is_trivially_copyable_v<Element> &&
                                     (std::is_const_v<Float> || !std::is_const_v<Element>)>>
  strided(Container &&elements)
      : strided(reinterpret_cast<Float *>(std::data(elements)), std::size(elements)) {}

  /// A view of outputs converts to a view of inputs.
  template <class Other, class = std::enable_if_t<std::is_same_v<const Other, Float>>>
  constexpr strided(const strided<Other, N> &other) : strided(other.data(), other.size(), other.stride()) {}

  constexpr Float *data() const { return data_; }
  constexpr std::size_t size() const { return size_; }
  /// Bytes from one element to the next.
  constexpr std::size_t stride() const { return stride_; }

 private:
  Float *data_ = nullptr;
  std::size_t size_ = 0;
  std::size_t stride_ = N * sizeof(float);
};

template <std::size_t N>
using floats = strided<const float, N>;

/// A view of one member of an array of structs: field(vertices, &Vertex::position). The member is float[3], or an engine's vector type.
template <class Container, class Struct, class Member>
auto field(Container &&structs, Member Struct::*member) {
  using Element = std::remove_pointer_t<decltype(std::data(structs))>;
  using Float = std::conditional_t<std::is_const_v<Element>, const float, float>;
  static_assert(sizeof(Member) % sizeof(float) == 0 && may_be_floats<Member> && std::is_trivially_copyable_v<Member>,
                "a member that is floats");
  Element *first = std::data(structs);
  Float *data = std::size(structs) == 0 ? nullptr : reinterpret_cast<Float *>(&(first->*member));
  return strided<Float, sizeof(Member) / sizeof(float)>(data, std::size(structs), sizeof(Element));
}

namespace detail {
/// The number that a row consists of: of T[K], and of a class that names it as value_type or Scalar. Other types are their own row.
template <class Row, class = void>
struct scalar {
  using type = std::remove_cv_t<std::remove_all_extents_t<Row>>;
};
template <class Row>
struct scalar<Row, std::void_t<typename Row::value_type>> {
  using type = std::remove_cv_t<typename Row::value_type>;
};
template <class Container>
using row_of = std::remove_cv_t<std::remove_pointer_t<decltype(std::data(std::declval<Container &>()))>>;
}  // namespace detail

/// A view of 16-bit or 32-bit indices: the vertex of each corner. Default-constructed: an unindexed mesh, whose corner i is vertex i.
class index_list {
 public:
  index_list() = default;

  /// A contiguous container of indices, or of triples of them: Index[3], std::array<Index, 3>, or an engine's vector type with a value_type.
  template <class Container, class Row = detail::row_of<Container>, class Index = typename detail::scalar<Row>::type,
            class = std::enable_if_t<(std::is_same_v<Index, std::uint32_t> || std::is_same_v<Index, std::uint16_t>) &&
                                     (sizeof(Row) == sizeof(Index) || sizeof(Row) == 3 * sizeof(Index)) &&
                                     std::is_trivially_copyable_v<Row>>>
  index_list(Container &&list) : size_(std::size(list) * (sizeof(Row) / sizeof(Index))) {
    // An empty index list differs from no index list, so its pointer must not be null.
    static const Index none = 0;
    const Index *data = size_ == 0 ? &none : reinterpret_cast<const Index *>(std::data(list));
    if constexpr (sizeof(Index) == sizeof *u32_) {
      u32_ = data;
    } else {
      u16_ = data;
    }
  }

  const std::uint32_t *u32() const { return u32_; }
  const std::uint16_t *u16() const { return u16_; }
  std::size_t size() const { return size_; }
  bool is_present() const { return u32_ != nullptr || u16_ != nullptr; }

 private:
  const std::uint32_t *u32_ = nullptr;
  const std::uint16_t *u16_ = nullptr;
  std::size_t size_ = 0;
};

/// A borrowed mesh, as darboux_mesh. The members are views: the arrays behind them must outlive the mesh.
struct mesh {
  floats<3> positions;
  floats<3> normals;
  floats<2> uvs;
  index_list indices;
  darboux_faces faces = DARBOUX_FACES_TRIANGLES;
  /// The corner count of each face, for DARBOUX_FACES_MIXED.
  span<const std::uint32_t> face_sizes = {};

  std::size_t corner_count() const { return indices.is_present() ? indices.size() : positions.size(); }

  /// The mesh for the functions of darboux.h. `normals` and `uvs` may be empty for functions that ignore them.
  darboux_mesh view() const {
    const std::size_t count = positions.size();
    if ((normals.size() != 0 && normals.size() != count) || (uvs.size() != 0 && uvs.size() != count)) {
      throw error(DARBOUX_STATUS_LENGTH, "normals and uvs must be as many as positions");
    }
    darboux_mesh view = {};
    view.size = sizeof view;
    view.vertex_count = count;
    view.positions = positions.data();
    view.position_stride = positions.stride();
    view.normals = normals.data();
    view.normal_stride = normals.stride();
    view.uvs = uvs.data();
    view.uv_stride = uvs.stride();
    view.indices_u32 = indices.u32();
    view.indices_u16 = indices.u16();
    view.index_count = indices.size();
    view.faces = faces;
    view.face_sizes = face_sizes.data();
    view.face_count = face_sizes.size();
    return view;
  }
};

/// One tangent per corner, and the report of the run.
struct tangents {
  std::vector<tangent> corners;
  darboux_report report;
};

/// One frame per corner, and the report of the run.
struct frames {
  std::vector<darboux_frame> corners;
  darboux_report report;
};

/// One normal per corner, and the report of the run.
struct normals {
  std::vector<normal> corners;
  darboux_normal_report report;
};

namespace detail {
template <class Struct>
Struct sized() {
  Struct made = {};
  made.size = sizeof made;
  return made;
}

template <auto Free>
struct deleter {
  template <class T>
  void operator()(T *held) const noexcept {
    Free(held);
  }
};

template <class T, auto Free>
using owner = std::unique_ptr<T, deleter<Free>>;
}  // namespace detail

/// Reused memory, threads for large meshes, and a cancellation flag. Functions take a pointer to it, which may be null.
class context {
 public:
  explicit context(std::size_t threads = 1) {
    darboux_context *made = nullptr;
    check(darboux_context_create(threads, &made));
    held_.reset(made);
  }
  darboux_context *get() const noexcept { return held_.get(); }

  /// Cancels the running call and all later ones, until resume(). Any thread may call it.
  void cancel() const { check(darboux_context_cancel(get())); }
  void resume() const { check(darboux_context_resume(get())); }

 private:
  detail::owner<darboux_context, darboux_context_free> held_;
};

namespace detail {
inline darboux_context *get(const context *context) noexcept { return context == nullptr ? nullptr : context->get(); }
}  // namespace detail

/// Computes one tangent per corner and writes it to the caller's array. `out`: as many elements as the mesh has corners.
inline darboux_report generate_tangents(const mesh &mesh, strided<float, 4> out,
                                        const darboux_tangent_options &options = {}, const context *context = nullptr) {
  const darboux_mesh view = mesh.view();
  auto report = detail::sized<darboux_report>();
  check(darboux_generate_tangents(&view, &options, detail::get(context), out.data(), out.size(), out.stride(),
                                  &report));
  return report;
}

inline tangents generate_tangents(const mesh &mesh, const darboux_tangent_options &options = {},
                                  const context *context = nullptr) {
  tangents made = {std::vector<tangent>(mesh.corner_count()), {}};
  made.report = generate_tangents(mesh, strided<float, 4>(made.corners), options, context);
  return made;
}

inline frames generate_frames(const mesh &mesh, const darboux_tangent_options &options = {}, const context *context = nullptr) {
  const darboux_mesh view = mesh.view();
  frames made = {std::vector<darboux_frame>(mesh.corner_count()), detail::sized<darboux_report>()};
  check(darboux_generate_frames(&view, &options, detail::get(context), made.corners.data(), made.corners.size(), 0,
                                &made.report));
  return made;
}

inline normals generate_normals(const mesh &mesh, const darboux_normal_options &options = {},
                                const context *context = nullptr) {
  const darboux_mesh view = mesh.view();
  normals made = {std::vector<normal>(mesh.corner_count()), detail::sized<darboux_normal_report>()};
  float *out = made.corners.empty() ? nullptr : made.corners.front().data();
  check(darboux_generate_normals(&view, &options, detail::get(context), out, made.corners.size(), 0, &made.report));
  return made;
}

/// The vertices of an indexed mesh after splitting by tangents. The old vertices come first and keep their numbers.
class vertex_split {
 public:
  explicit vertex_split(darboux_vertex_split *made) : held_(made) {}
  std::size_t vertex_count() const { return held_->vertex_count; }
  span<const tangent> tangent_of_vertex() const {
    return {reinterpret_cast<const tangent *>(held_->tangent_of_vertex), held_->vertex_count};
  }
  span<const std::uint32_t> source_of_vertex() const { return {held_->source_of_vertex, held_->vertex_count}; }
  span<const std::uint32_t> indices() const { return {held_->indices, held_->index_count}; }

 private:
  detail::owner<darboux_vertex_split, darboux_vertex_split_free> held_;
};

inline vertex_split split_vertices(const mesh &mesh, floats<4> tangents, const context *context = nullptr) {
  const darboux_mesh view = mesh.view();
  darboux_vertex_split *made = nullptr;
  check(darboux_split_vertices(&view, tangents.data(), tangents.size(), tangents.stride(), detail::get(context), &made));
  return vertex_split(made);
}

/// Computes the tangents of indexed triangles and writes them into the caller's vertices. Vertices that need several tangents are copied: copies are
/// appended to `vertices`, and `indices` changes. The sign w is MikkTSpace's; conversion::tangents changes it for a program.
///
/// `vertices`: a std::vector of structs, or a container like it. Their members: position, normal, uv and tangent, of 3, 3, 2 and 4 floats.
/// `indices`: as for index_list, 32 or 16 bits. Errors: those of generate_tangents; DARBOUX_STATUS_TOO_LARGE where 16 bits are too few for the new
/// vertices. After an error nothing has changed.
template <class Vertices, class Struct, class Position, class Normal, class Uv, class Indices, class Tangent>
darboux_report add_tangents(Vertices &vertices, Position Struct::*position_member, Normal Struct::*normal_member, Uv Struct::*uv_member, Indices &indices,
                            Tangent Struct::*tangent_member, const darboux_tangent_options &options = {}, const context *context = nullptr) {
  using Index = typename detail::scalar<detail::row_of<Indices>>::type;
  const Vertices &read = vertices;
  const mesh mesh = {field(read, position_member), field(read, normal_member), field(read, uv_member), index_list(indices)};
  const tangents made = generate_tangents(mesh, options, context);
  const vertex_split split = split_vertices(mesh, made.corners, context);
  const std::size_t old_count = vertices.size(), new_count = split.vertex_count();
  if (new_count - (new_count > 0) > std::numeric_limits<Index>::max()) {
    throw error(DARBOUX_STATUS_TOO_LARGE, "the split vertices are too many for the type of the indices; use 32 bits");
  }
  vertices.reserve(new_count);
  for (std::size_t vertex = old_count; vertex < new_count; vertex++) {
    Struct copy = vertices[split.source_of_vertex()[vertex]];
    vertices.push_back(std::move(copy));
  }
  const strided<float, 4> out = field(vertices, tangent_member);
  for (std::size_t vertex = 0; vertex < new_count; vertex++) {
    std::memcpy(reinterpret_cast<char *>(out.data()) + vertex * out.stride(), split.tangent_of_vertex()[vertex].data(), sizeof(darboux::tangent));
  }
  Index *new_indices = reinterpret_cast<Index *>(std::data(indices));
  for (const std::uint32_t index : split.indices()) *new_indices++ = Index(index);
  return made.report;
}

/// The vertices of an indexed mesh after splitting by normals. The old vertices come first and keep their numbers.
class normal_split {
 public:
  explicit normal_split(darboux_normal_split *made) : held_(made) {}
  std::size_t vertex_count() const { return held_->vertex_count; }
  span<const normal> normal_of_vertex() const {
    return {reinterpret_cast<const normal *>(held_->normal_of_vertex), held_->vertex_count};
  }
  span<const std::uint32_t> source_of_vertex() const { return {held_->source_of_vertex, held_->vertex_count}; }
  span<const std::uint32_t> indices() const { return {held_->indices, held_->index_count}; }

 private:
  detail::owner<darboux_normal_split, darboux_normal_split_free> held_;
};

inline normal_split split_normals(const mesh &mesh, floats<3> normals, const context *context = nullptr) {
  const darboux_mesh view = mesh.view();
  darboux_normal_split *made = nullptr;
  check(darboux_split_normals(&view, normals.data(), normals.size(), normals.stride(), detail::get(context), &made));
  return normal_split(made);
}

/// A plan (darboux_plan): the topology of a mesh, for computing the tangents of its deformed copies.
class plan {
 public:
  explicit plan(const mesh &mesh, const darboux_tangent_options &options = {}, const context *context = nullptr) {
    const darboux_mesh view = mesh.view();
    darboux_plan *made = nullptr;
    check(darboux_plan_create(&view, &options, detail::get(context), &made));
    held_.reset(made);
  }

  /// Writes the tangents of the mesh that the plan was created from. `out`: one tangent per corner.
  darboux_report base(strided<float, 4> out) const {
    auto report = detail::sized<darboux_report>();
    check(darboux_plan_base(held_.get(), out.data(), out.size(), out.stride(), &report));
    return report;
  }

  /// Computes the tangents of a deformed mesh. `out`: one tangent per corner.
  void evaluate(const mesh &moved, strided<float, 4> out, const context *context = nullptr) const {
    const darboux_mesh view = moved.view();
    check(darboux_plan_evaluate(held_.get(), &view, detail::get(context), out.data(), out.size(), out.stride()));
  }

  std::vector<tangent> evaluate(const mesh &moved, const context *context = nullptr) const {
    std::vector<tangent> made(moved.corner_count());
    evaluate(moved, made, context);
    return made;
  }

  std::size_t count_regrouped(const mesh &moved, const context *context = nullptr) const {
    const darboux_mesh view = moved.view();
    std::size_t count = 0;
    check(darboux_plan_count_regrouped(held_.get(), &view, detail::get(context), &count));
    return count;
  }

 private:
  detail::owner<darboux_plan, darboux_plan_free> held_;
};

inline darboux_tangent_difference measure_tangents(floats<4> a, floats<4> b, const context *context = nullptr) {
  if (a.size() != b.size()) throw error(DARBOUX_STATUS_LENGTH, "both must have as many tangents");
  auto difference = detail::sized<darboux_tangent_difference>();
  check(darboux_measure_tangents(a.size(), a.data(), a.stride(), b.data(), b.stride(), detail::get(context), &difference));
  return difference;
}

/// The verdict on a normal map of `height` rows of `width` texels with `channels` channels of `bits` bits.
inline darboux_map_judgement judge_normal_map(
    const void *texels, std::uint32_t bits, std::uint32_t channels, std::size_t width, std::size_t height, std::size_t row_stride = 0) {
  auto judgement = detail::sized<darboux_map_judgement>();
  check(darboux_judge_normal_map(static_cast<const std::uint8_t *>(texels), bits, channels, width, height, row_stride, &judgement));
  return judgement;
}

/// All recipes of the tangents, the best one first.
inline std::vector<darboux_recipe_match> recognise_recipe(
    const mesh &mesh, floats<4> tangents, const context *context = nullptr) {
  const darboux_mesh view = mesh.view();
  std::vector<darboux_recipe_match> matches(64);
  std::size_t count = 0;
  check(darboux_recognise_recipe(
      &view, tangents.data(), tangents.size(), tangents.stride(), detail::get(context), matches.data(), matches.size(), &count));
  matches.resize(count < matches.size() ? count : matches.size());
  return matches;
}

inline darboux_uv_fidelity measure_uv_fidelity(const mesh &mesh, floats<4> tangents, const context *context = nullptr) {
  const darboux_mesh view = mesh.view();
  auto fidelity = detail::sized<darboux_uv_fidelity>();
  check(darboux_measure_uv_fidelity(&view, tangents.data(), tangents.size(), tangents.stride(), detail::get(context),
                                    &fidelity));
  return fidelity;
}

/// The type of one tangent in a compressed format.
template <darboux_tangent_encoding Encoding>
struct encoded_tangent;
template <>
struct encoded_tangent<DARBOUX_TANGENT_ENCODING_SNORM8> {
  using type = std::array<std::int8_t, 4>;
};
template <>
struct encoded_tangent<DARBOUX_TANGENT_ENCODING_SNORM10> {
  using type = std::uint32_t;
};
template <>
struct encoded_tangent<DARBOUX_TANGENT_ENCODING_SNORM16> {
  using type = std::array<std::int16_t, 4>;
};
template <>
struct encoded_tangent<DARBOUX_TANGENT_ENCODING_OCTAHEDRAL> {
  using type = std::array<std::int16_t, 2>;
};
template <>
struct encoded_tangent<DARBOUX_TANGENT_ENCODING_DIAMOND> {
  using type = std::uint16_t;
};

namespace detail {
/// Errors: another number of normals than of tangents; no normals are as good as all where the encoding ignores them.
inline void check_normals(std::size_t normals, std::size_t tangents) {
  if (normals != 0 && normals != tangents) throw error(DARBOUX_STATUS_LENGTH, "normals must be as many as tangents");
}
}  // namespace detail

/// As darboux_encode_tangents: encode_tangents<DARBOUX_TANGENT_ENCODING_SNORM8>(tangents). `normals`: for the format DIAMOND only.
template <darboux_tangent_encoding Encoding, class Code = typename encoded_tangent<Encoding>::type>
std::vector<Code> encode_tangents(floats<4> tangents, floats<3> normals = {}) {
  detail::check_normals(normals.size(), tangents.size());
  std::vector<Code> codes(tangents.size());
  check(darboux_encode_tangents(Encoding, tangents.size(), normals.data(), normals.stride(), tangents.data(), tangents.stride(),
                                codes.data(), sizeof(Code)));
  return codes;
}

/// As darboux_decode_tangents. `normals`: for the format DIAMOND only.
template <darboux_tangent_encoding Encoding>
std::vector<tangent> decode_tangents(span<const typename encoded_tangent<Encoding>::type> codes, floats<3> normals = {}) {
  detail::check_normals(normals.size(), codes.size());
  std::vector<tangent> tangents(codes.size());
  check(darboux_decode_tangents(Encoding, codes.size(), normals.data(), normals.stride(), codes.data(), sizeof(*codes.data()),
                                reinterpret_cast<float *>(tangents.data()), sizeof(tangent)));
  return tangents;
}

/// As darboux_encode_normals.
inline std::vector<std::array<std::int16_t, 2>> encode_normals(floats<3> normals) {
  std::vector<std::array<std::int16_t, 2>> codes(normals.size());
  check(darboux_encode_normals(normals.size(), normals.data(), normals.stride(), reinterpret_cast<std::int16_t *>(codes.data()), sizeof(codes[0])));
  return codes;
}

/// As darboux_decode_normals.
inline std::vector<normal> decode_normals(span<const std::array<std::int16_t, 2>> codes) {
  std::vector<normal> normals(codes.size());
  check(darboux_decode_normals(codes.size(), reinterpret_cast<const std::int16_t *>(codes.data()), sizeof(*codes.data()), reinterpret_cast<float *>(normals.data()), sizeof(normal)));
  return normals;
}

/// As darboux_encode_frames.
inline std::vector<std::array<std::int16_t, 4>> encode_frames(floats<3> normals, floats<4> tangents) {
  if (normals.size() != tangents.size()) throw error(DARBOUX_STATUS_LENGTH, "tangents must be as many as normals");
  std::vector<std::array<std::int16_t, 4>> codes(normals.size());
  check(darboux_encode_frames(normals.size(), normals.data(), normals.stride(), tangents.data(), tangents.stride(),
                              reinterpret_cast<std::int16_t *>(codes.data()), sizeof(codes[0])));
  return codes;
}

/// As darboux_decode_frames, into arrays of as many elements.
inline void decode_frames(span<const std::array<std::int16_t, 4>> codes, strided<float, 3> normals, strided<float, 4> tangents) {
  if (normals.size() != codes.size() || tangents.size() != codes.size()) {
    throw error(DARBOUX_STATUS_LENGTH, "normals and tangents must be as many as codes");
  }
  check(darboux_decode_frames(codes.size(), reinterpret_cast<const std::int16_t *>(codes.data()), sizeof(*codes.data()), normals.data(), normals.stride(),
                              tangents.data(), tangents.stride()));
}

/// The convention of a program.
inline darboux_convention convention_of(darboux_program program) {
  auto convention = detail::sized<darboux_convention>();
  check(darboux_convention_of(program, &convention));
  return convention;
}

/// The convention of the tangents that generate_tangents returns for a mesh in `convention`.
inline darboux_convention generated(const darboux_convention &convention) {
  auto made = detail::sized<darboux_convention>();
  check(darboux_convention_generated(&convention, &made));
  return made;
}

/// The conversion from one convention to another. Arrays are converted in place.
class conversion {
 public:
  conversion(const darboux_convention &from, const darboux_convention &to) : from_(from), to_(to) {}

  void vectors(strided<float, 3> in) const {
    check(darboux_convert_vectors(&from_, &to_, in.size(), in.data(), in.stride(), in.data(), in.stride()));
  }
  void tangents(strided<float, 4> in) const {
    check(darboux_convert_tangents(&from_, &to_, in.size(), in.data(), in.stride(), in.data(), in.stride()));
  }
  void uvs(strided<float, 2> in) const {
    check(darboux_convert_uvs(&from_, &to_, in.size(), in.data(), in.stride(), in.data(), in.stride()));
  }
  /// Converts the winding. `corners`: the indices, or any other attribute of corners. `sizes`: the corner counts of mixed faces.
  template <class Container, class Element = std::remove_pointer_t<decltype(std::data(std::declval<Container &>()))>,
            class = std::enable_if_t<std::is_trivially_copyable_v<Element>>>
  void faces(Container &&corners, darboux_faces faces = DARBOUX_FACES_TRIANGLES,
             span<const std::uint32_t> sizes = {}) const {
    check(darboux_convert_faces(&from_, &to_, faces, sizes.data(), sizes.size(), std::data(corners),
                                std::size(corners), sizeof(Element)));
  }
  /// True for each channel (red, green) of a normal map that is inverted.
  std::array<bool, 2> channels() const {
    std::uint32_t red = 0, green = 0;
    check(darboux_convert_channels(&from_, &to_, &red, &green));
    return {red != 0, green != 0};
  }

 private:
  darboux_convention from_;
  darboux_convention to_;
};

/// Transforms normals and tangents in place. `matrix`: 4 by 4, column-major. Returns -1 where the matrix mirrors, else +1.
inline float transform_frames(const std::array<float, 16> &matrix, strided<float, 3> normals, strided<float, 4> tangents) {
  if (normals.size() != tangents.size()) throw error(DARBOUX_STATUS_LENGTH, "tangents must be as many as normals");
  auto arrays = detail::sized<darboux_frame_arrays>();
  arrays.count = normals.size();
  arrays.normals = arrays.out_normals = normals.data();
  arrays.normal_stride = arrays.out_normal_stride = normals.stride();
  arrays.tangents = arrays.out_tangents = tangents.data();
  arrays.tangent_stride = arrays.out_tangent_stride = tangents.stride();
  float orientation = 1;
  check(darboux_transform_frames(matrix.data(), 16, &arrays, &orientation));
  return orientation;
}

/// A strided view of rows of as many numbers each: the joints or the weights of vertices.
template <class Number>
class rows {
 public:
  /// `size` rows of `width` numbers, the first at `data`, `stride` bytes apart.
  rows(const Number *data, std::size_t size, std::size_t width, std::size_t stride)
      : data_(data), size_(size), width_(width), stride_(stride) {}

  /// A contiguous container of rows: Number[K], std::array<Number, K>, or an engine's vector type with a value_type.
  template <class Container, class Row = detail::row_of<Container>,
            class = std::enable_if_t<std::is_same_v<typename detail::scalar<Row>::type, Number> && std::is_trivially_copyable_v<Row>>>
  rows(Container &&list)
      : rows(reinterpret_cast<const Number *>(std::data(list)), std::size(list), sizeof(Row) / sizeof(Number), sizeof(Row)) {}

  /// One member of an array of structs.
  template <class Container, class Struct, class Member,
            class = std::enable_if_t<std::is_same_v<typename detail::scalar<Member>::type, Number> && std::is_trivially_copyable_v<Member>>>
  rows(Container &&structs, Member Struct::*member)
      : rows(std::size(structs) == 0 ? nullptr : reinterpret_cast<const Number *>(&(std::data(structs)->*member)), std::size(structs),
             sizeof(Member) / sizeof(Number), sizeof(Struct)) {}

  const Number *data() const { return data_; }
  std::size_t size() const { return size_; }
  /// The numbers of each row.
  std::size_t width() const { return width_; }
  /// Bytes from one row to the next.
  std::size_t stride() const { return stride_; }

 private:
  const Number *data_;
  std::size_t size_;
  std::size_t width_;
  std::size_t stride_;
};

/// Transforms normals and tangents by a skin, in place. `bones`: the matrix of each bone, 4 by 4, column-major, from the pose of the arrays to the
/// current pose. `joints`, `weights`: those of each vertex, as many joints as weights.
inline void skin_frames(floats<16> bones, const rows<std::uint16_t> &joints, const rows<float> &weights, strided<float, 3> normals,
                        strided<float, 4> tangents) {
  const std::size_t count = normals.size();
  if (tangents.size() != count || joints.size() != count || weights.size() != count) {
    throw error(DARBOUX_STATUS_LENGTH, "tangents, joints and weights must be as many as normals");
  }
  if (joints.width() != weights.width()) throw error(DARBOUX_STATUS_LENGTH, "a vertex must have as many weights as joints");
  auto skin = detail::sized<darboux_skin>();
  skin.bones = bones.data();
  skin.bone_count = bones.size();
  skin.bone_stride = bones.stride();
  skin.influence_count = joints.width();
  skin.joints = joints.data();
  skin.joint_stride = joints.stride();
  skin.weights = weights.data();
  skin.weight_stride = weights.stride();
  auto arrays = detail::sized<darboux_frame_arrays>();
  arrays.count = count;
  arrays.normals = arrays.out_normals = normals.data();
  arrays.normal_stride = arrays.out_normal_stride = normals.stride();
  arrays.tangents = arrays.out_tangents = tangents.data();
  arrays.tangent_stride = arrays.out_tangent_stride = tangents.stride();
  check(darboux_skin_frames(&skin, &arrays));
}

}  // namespace darboux

#if __cplusplus >= 202002L
#include <ranges>
#endif

#ifdef __cpp_lib_ranges
/// The elements outlive the span, so that std::span can be constructed from a temporary span.
template <class T>
inline constexpr bool std::ranges::enable_borrowed_range<darboux::span<T>> = true;
#endif

#endif  // DARBOUX_HPP
