#include "vibe_core/simulation/snapshot.hpp"

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <sstream>

#include "simulation/procedure_check.hpp"
#include "simulation/procedure_fields.hpp"
#include "vibe_core/common/error.hpp"
#include "vibe_core/simulation/simulator.hpp"

namespace vibe {

namespace {

constexpr std::uint64_t kReadAtOnce = 1 << 16;  // numbers
constexpr char kMagic[8] = {'v', 'i', 'b', 'e', 's', 'n', 'p', '4'};

// One list of the members for both directions, so that they cannot differ.
template <class Archive, class S>
void transfer(Archive& archive, S& s) {
  archive.value(s.step);
  archive.value(s.time);
  archive.value(s.seed);
  archive.value(s.random);
  for (auto* v :
       {&s.x, &s.y, &s.z, &s.vx, &s.vy, &s.vz, &s.ax, &s.ay, &s.az, &s.qw, &s.qx, &s.qy, &s.qz, &s.wx, &s.wy, &s.wz})
    archive.array(*v);
  archive.value(s.gas_amount);
  archive.value(s.pressure);
  archive.value(s.volume);
  archive.value(s.pressure_reached);
  archive.value(s.joints);
  archive.grip(s.grip);
  archive.value(s.helix_pressed);
  archive.value(s.in_contact);
  archive.value(s.untouched_time);
  archive.vector(s.tool_force);
  archive.vector(s.tool_torque);
  archive.value(s.grip_force);
  archive.value(s.contact_count);
  visitProcedure(archive, s.procedure);
  visitPullSpring(archive, s.pull);
  archive.value(s.energy);
  archive.optionalArray(s.solver.linearization_point);
  archive.optionalArray(s.solver.next);
  archive.value(s.solver.linearization_id);
  archive.value(s.solver.next_id);
  archive.value(s.solver.steps);
  archive.value(s.solver.elastic_energy);
  archive.value(s.solver.rest_steps);
  archive.value(s.solver.due);
  archive.value(s.solver.usual_length);
  archive.value(s.solver.recovery_steps);
  archive.value(s.solver.fallback);
}

class Writer {
 public:
  explicit Writer(std::ostream& out) : out_(out) {}
  template <class T>
  void value(const T& v) {
    out_.write(reinterpret_cast<const char*>(&v), sizeof v);
  }
  void vector(const Eigen::Vector3d& v) { out_.write(reinterpret_cast<const char*>(v.data()), 3 * sizeof(double)); }
  void array(const std::vector<double>& v) {
    out_.write(reinterpret_cast<const char*>(v.data()), static_cast<std::streamsize>(v.size() * sizeof(double)));
  }
  void optionalArray(const std::vector<float>& v) {
    value(static_cast<std::uint64_t>(v.size()));
    out_.write(reinterpret_cast<const char*>(v.data()), static_cast<std::streamsize>(v.size() * sizeof(float)));
  }
  template <class T>
  void numbers(const std::vector<T>& v) {
    value(static_cast<std::uint64_t>(v.size()));
    out_.write(reinterpret_cast<const char*>(v.data()), static_cast<std::streamsize>(v.size() * sizeof(T)));
  }
  template <class T, class Visit>
  void list(const std::vector<T>& items, Visit visit) {
    value(static_cast<std::uint64_t>(items.size()));
    for (const T& item : items) visit(item);
  }
  void grip(const std::vector<GripPoint>& grip) {
    value(static_cast<std::uint64_t>(grip.size()));
    for (const GripPoint& point : grip) {
      value(point.particle);
      vector(point.local);
    }
  }

 private:
  std::ostream& out_;
};

class Reader {
 public:
  Reader(std::istream& in, std::string file, int particles) : in_(in), file_(std::move(file)), particles_(particles) {}
  template <class T>
  void value(T& v) {
    read(&v, sizeof v);
  }
  void value(bool& v) {
    std::uint8_t byte = 0;
    value(byte);
    if (byte > 1)
      throw Error("Snapshot '" + file_ + "' is damaged: a flag in it is neither set nor not; save it again.");
    v = byte == 1;
  }
  void vector(Eigen::Vector3d& v) { read(v.data(), 3 * sizeof(double)); }
  // A damaged count must end at the end of the file, not with all memory: both grow only with what has been read.
  template <class T>
  void numbers(std::vector<T>& v) {
    std::uint64_t count = 0;
    value(count);
    v.clear();
    while (v.size() < count) {
      const std::size_t begin = v.size();
      v.resize(begin + std::min<std::uint64_t>(count - begin, kReadAtOnce));
      read(v.data() + begin, (v.size() - begin) * sizeof(T));
    }
  }
  template <class T, class Visit>
  void list(std::vector<T>& items, Visit visit) {
    std::uint64_t count = 0;
    value(count);
    items.clear();
    for (std::uint64_t i = 0; i < count; ++i) visit(items.emplace_back());
  }
  void array(std::vector<double>& v) {
    v.resize(static_cast<std::size_t>(particles_));
    read(v.data(), v.size() * sizeof(double));
  }
  void optionalArray(std::vector<float>& v) {
    std::uint64_t count = 0;
    value(count);
    if (count != 0 && count != 3 * static_cast<std::uint64_t>(particles_))
      throw Error("Snapshot '" + file_ + "' is damaged: its solver remembers another organ; save it again.");
    v.resize(count);
    read(v.data(), count * sizeof(float));
  }
  void grip(std::vector<GripPoint>& grip) {
    std::uint64_t count = 0;
    value(count);
    if (count > static_cast<std::uint64_t>(particles_))
      throw Error("Snapshot '" + file_ + "' is damaged: it holds more tissue than there is; save it again.");
    grip.resize(count);
    for (GripPoint& point : grip) {
      value(point.particle);
      vector(point.local);
      if (point.particle < 0 || point.particle >= particles_)
        throw Error("Snapshot '" + file_ + "' is damaged: it holds a particle that does not exist; save it again.");
    }
  }

 private:
  void read(void* data, std::size_t size) {
    in_.read(static_cast<char*>(data), static_cast<std::streamsize>(size));
    if (!in_) throw Error("Snapshot '" + file_ + "' ends too early; save it again.");
  }
  std::istream& in_;
  std::string file_;
  int particles_;
};

// Rest shape, masses, step and which parts there are: what a state must agree with to be continued.
std::uint64_t fingerprint(const Model& model) {
  State rest;
  for (const Eigen::Vector3d& p : model.organ.surface.vertices) {
    rest.x.push_back(p.x());
    rest.y.push_back(p.y());
    rest.z.push_back(p.z());
  }
  rest.vx = model.mass;
  rest.vy = model.inverse_mass;
  rest.gas_amount = model.scene.step_period;
  rest.step = model.substeps;
  for (char c : model.scene.tissue.model) rest.random = rest.random * 31 + static_cast<unsigned char>(c);
  for (bool part : {model.scene.scope.has_value(), model.scene.helix.has_value(), model.scene.suture.has_value(),
                    model.scene.marking.has_value()})
    rest.random = rest.random * 2 + (part ? 1 : 0);
  return hash(rest);
}

}  // namespace

void saveSnapshot(const Model& model, const State& state, const std::string& file) {
  const std::string part = file + ".part";
  {
    std::ofstream out(part, std::ios::binary | std::ios::trunc);
    Writer writer(out);
    writer.value(kMagic);
    writer.value(fingerprint(model));
    transfer(writer, state);
    out.flush();
    if (!out) throw Error("Snapshot '" + file + "' could not be written; check that the folder exists and has room.");
  }
  if (std::rename(part.c_str(), file.c_str()) != 0)
    throw Error("Snapshot '" + file + "' could not be put in place; check the permissions of its folder.");
}

State loadSnapshot(const Model& model, const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) throw Error("Snapshot '" + file + "' cannot be opened; check the path.");
  Reader reader(in, file, model.particle_count);
  char magic[sizeof kMagic] = {};
  reader.value(magic);
  if (std::memcmp(magic, kMagic, sizeof kMagic) != 0)
    throw Error("'" + file + "' is no snapshot of this version; save it again with this build.");
  std::uint64_t saved = 0;
  reader.value(saved);
  if (saved != fingerprint(model))
    throw Error("Snapshot '" + file + "' belongs to another scene; load the scene it was saved with first.");
  State state;
  transfer(reader, state);
  std::string damage = findDamage(state.procedure, model.particle_count);
  if (damage.empty()) damage = findDamage(state.pull, model.particle_count);
  if (!damage.empty()) throw Error("Snapshot '" + file + "' is damaged: " + damage + "; save it again.");
  if (model.scene.marking && state.procedure.dose.empty())
    throw Error("Snapshot '" + file + "' is damaged: its marks are missing; save it again.");
  if (in.peek() != std::ifstream::traits_type::eof())
    throw Error("Snapshot '" + file + "' is longer than a state; save it again.");
  return state;
}

}  // namespace vibe
