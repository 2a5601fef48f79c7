// sources: src/simulation/snapshot.cpp src/simulation/state_check.cpp src/files/files.cpp src/scene/[!m]*.cpp
// sources: src/geometry/stomach_knots.cpp src/geometry/surface_mesh.cpp src/program/plugins.cpp
// sources: src/files/foreign_content.cpp src/files/number_text.cpp src/arithmetic/elementary_*.cpp
// packages: yaml-cpp
// includes: ../vibe_firmware/fuzz
#include <sys/mman.h>
#include <unistd.h>

#include <fstream>
#include <iterator>
#include <string>

#include "fuzz_input.hpp"
#include "vibe_core/files/fnv1a.hpp"
#include "vibe_core/program/error.hpp"
#include "vibe_core/simulation/snapshot.hpp"

// Any bytes, and the bytes of a state with some of them changed, as the body of a snapshot with the right header and
// checksum: an Error with its sentence, or a state that is saved to the same bytes again.

namespace {

using namespace vibe;
using vibe_firmware::require;

constexpr int kParticles = 4;
constexpr std::size_t kHeader = 32, kSum = 8;  // magic, version, three fingerprints; then the body; then the checksum

Model makeModel() {
  Model model;
  model.particle_count = kParticles;
  model.organ.surface.vertices.assign(kParticles, Eigen::Vector3d::Ones());
  model.mass = model.inverse_mass = std::vector<double>(kParticles, 1);
  return model;
}

/// A state in which every list has an item.
State busyState() {
  State s;
  for (auto* list :
       {&s.x, &s.y, &s.z, &s.vx, &s.vy, &s.vz, &s.ax, &s.ay, &s.az, &s.qw, &s.qx, &s.qy, &s.qz, &s.wx, &s.wy, &s.wz})
    list->assign(kParticles, 0.5);
  Bite bite;
  bite.particle = {1, 2};
  bite.weight = {0.5, 0.5};
  Suture suture;
  suture.stage = Suture::Stage::Cinched;
  suture.bites = {bite, bite};
  suture.length = suture.tension = {0.5};
  suture.taken = {Eigen::Vector3d::Ones()};
  suture.group = {{1}, {Eigen::Vector3d::Ones()}, {2}, {1}, 0.5};
  s.grip = {{1, Eigen::Vector3d::Ones()}};
  s.pull = {1, {1, 2}, {0.5, 0.5}, Eigen::Vector3d::Ones(), Eigen::Vector3d::Ones()};
  s.procedure.heat = s.procedure.dose = std::vector<float>(kParticles, 1);
  s.procedure.grade.assign(kParticles, 1);
  s.procedure.pending = bite;
  s.procedure.sutures = {suture};
  s.procedure.bleedings = {Bleeding{0, 1, 2}};
  s.solver.linearization_point.assign(3 * kParticles, 1);
  s.solver.couplings.resize(1);
  s.impedance.current.node = {1};
  s.impedance.current.direction.resize(1);
  s.impedance.current.row_motion.resize(1);
  return s;
}

std::string saved(const State& state) {
  static const Model model = makeModel();
  const std::string file = "/tmp/snapshot_fuzz." + std::to_string(getpid());
  saveSnapshot(model, state, file);
  std::ifstream in(file, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(in), {}};
  unlink(file.c_str());
  return bytes;
}

void load(const std::string& body) {
  static const Model model = makeModel();
  static const std::string header = saved(State{}).substr(0, kHeader);
  std::string bytes = header + body;
  Fnv1a sum;
  sum.add(bytes.data(), bytes.size());
  const std::uint64_t value = sum.result();
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
  const int file = memfd_create("snapshot", 0);
  require(file >= 0 && write(file, bytes.data(), bytes.size()) == static_cast<ssize_t>(bytes.size()));
  try {
    require(saved(loadSnapshot(model, "/proc/self/fd/" + std::to_string(file))) == bytes);
  } catch (const Error& error) {
    require(error.what()[0] != '\0');
  }
  close(file);
}

/// Triples of bytes say what changes where.
std::string changed(const std::uint8_t* data, std::size_t size) {
  static const std::string whole = saved(busyState());
  std::string body = whole.substr(kHeader, whole.size() - kHeader - kSum);
  for (std::size_t i = 0; i + 2 < size; i += 3)
    body[(static_cast<std::size_t>(data[i]) << 8 | data[i + 1]) % body.size()] = static_cast<char>(data[i + 2]);
  return body;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  load(std::string(data, data + size));
  load(changed(data, size));
  return 0;
}
