// Checks the promises of mikktspace.h about callbacks: which are called, how often, in which order, on which thread, and that they may
// throw exceptions.

#include <cstdio>
#include <cstdlib>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "mikktspace.h"

struct Log {
  std::vector<int> sizes;
  std::string calls;
  std::thread::id thread = std::this_thread::get_id();
  // The number of the call that throws; -1 for none.
  int throws_at = -1;
  int count = 0;

  void note(const std::string &call) {
    if (std::this_thread::get_id() != thread) calls += "another thread! ";
    if (count++ == throws_at) throw std::runtime_error("thrown");
    calls += call + " ";
  }
};

static Log &log_of(const SMikkTSpaceContext *context) { return *static_cast<Log *>(context->m_pUserData); }

static std::string at(const char *name, int face, int corner) {
  return std::string(name) + std::to_string(face) + "." + std::to_string(corner);
}

static int face_count(const SMikkTSpaceContext *context) {
  log_of(context).note("faces");
  return int(log_of(context).sizes.size());
}

static int face_size(const SMikkTSpaceContext *context, int face) {
  log_of(context).note("size" + std::to_string(face));
  return log_of(context).sizes[std::size_t(face)];
}

static void position(const SMikkTSpaceContext *context, float out[], int face, int corner) {
  log_of(context).note(at("p", face, corner));
  out[0] = float(corner % 3 == 1 || corner == 2), out[1] = float(corner / 2), out[2] = float(face);
}

static void normal(const SMikkTSpaceContext *context, float out[], int face, int corner) {
  log_of(context).note(at("n", face, corner));
  out[0] = 0, out[1] = 0, out[2] = 1;
}

static void uv(const SMikkTSpaceContext *context, float out[], int face, int corner) {
  log_of(context).note(at("t", face, corner));
  out[0] = float(corner % 3 == 1 || corner == 2), out[1] = float(corner / 2);
}

static void basic(const SMikkTSpaceContext *context, const float[], float, int face, int corner) {
  log_of(context).note(at("basic", face, corner));
}

static void full(const SMikkTSpaceContext *context, const float[], const float[], float, float, tbool, int face, int corner) {
  log_of(context).note(at("full", face, corner));
}

static const SMikkTSpaceInterface ALL = {face_count, face_size, position, normal, uv, basic, full};

static void expect(bool holds, const std::string &what) {
  if (holds) return;
  std::fprintf(stderr, "%s\n", what.c_str());
  std::exit(1);
}

static tbool run(Log &log, SMikkTSpaceInterface callbacks) {
  const SMikkTSpaceContext context = {&callbacks, &log};
  return genTangSpaceDefault(&context);
}

static void expect_calls(std::vector<int> sizes, SMikkTSpaceInterface callbacks, tbool result, const std::string &calls) {
  Log log;
  log.sizes = std::move(sizes);
  expect(run(log, callbacks) == result, "another result than expected, after: " + log.calls);
  expect(log.calls == calls, "expected " + calls + "\nfound    " + log.calls);
}

static void order() {
  SMikkTSpaceInterface only_basic = ALL, only_full = ALL, none = ALL;
  only_basic.m_setTSpace = nullptr;
  only_full.m_setTSpaceBasic = nullptr;
  none.m_setTSpace = nullptr, none.m_setTSpaceBasic = nullptr;
  const std::string read = "faces size0 p0.0 n0.0 t0.0 p0.1 n0.1 t0.1 p0.2 n0.2 t0.2 ";
  expect_calls({3}, ALL, 1, read + "full0.0 basic0.0 full0.1 basic0.1 full0.2 basic0.2 ");
  expect_calls({3}, only_basic, 1, read + "basic0.0 basic0.1 basic0.2 ");
  expect_calls({3}, only_full, 1, read + "full0.0 full0.1 full0.2 ");
  expect_calls({3}, none, 1, read);
  expect_calls({5, -1, 3, 2}, only_basic, 1,
               "faces size0 size1 size2 size3 p0.0 p2.0 n2.0 t2.0 p2.1 n2.1 t2.1 p2.2 n2.2 t2.2 basic2.0 basic2.1 basic2.2 ");
  expect_calls({}, ALL, 0, "faces ");
  expect_calls({5, 2, 0}, ALL, 0, "faces size0 size1 size2 ");
}

static void missing() {
  for (int which = 0; which < 5; which++) {
    SMikkTSpaceInterface callbacks = ALL;
    if (which == 0) callbacks.m_getNumFaces = nullptr;
    if (which == 1) callbacks.m_getNumVerticesOfFace = nullptr;
    if (which == 2) callbacks.m_getPosition = nullptr;
    if (which == 3) callbacks.m_getNormal = nullptr;
    if (which == 4) callbacks.m_getTexCoord = nullptr;
    expect_calls({3, 4}, callbacks, 0, "");
  }
  const SMikkTSpaceContext no_interface = {nullptr, nullptr};
  expect(genTangSpaceDefault(&no_interface) == 0, "a null interface is no error");
  expect(genTangSpace(nullptr, 180) == 0, "a null context is no error");
}

static void exceptions() {
  // A triangle and a quad: 1 + 2 calls for counts, 21 for reading, 14 for writing.
  const int calls = 1 + 2 + 3 * 7 + 2 * 7;
  for (int call = 0; call < calls; call++) {
    Log log;
    log.sizes = {3, 4};
    log.throws_at = call;
    bool caught = false;
    try {
      run(log, ALL);
    } catch (const std::runtime_error &) {
      caught = true;
    }
    expect(caught, "call " + std::to_string(call) + " threw, and nothing arrived");
  }
}

static void threads() {
  std::vector<std::thread> running;
  for (int i = 0; i < 8; i++) {
    running.emplace_back([] {
      for (int round = 0; round < 50; round++) {
        Log log;
        log.sizes = {3, 4, 5, 4};
        expect(run(log, ALL) == 1 && log.calls.find('!') == std::string::npos, "a thread went wrong");
      }
    });
  }
  for (auto &thread : running) thread.join();
}

int main() {
  order();
  missing();
  exceptions();
  threads();
  return 0;
}
