#include <cstring>

#include "simulation/procedure_fields.hpp"
#include "vibe_core/simulation/simulator.hpp"

namespace vibe {

namespace {

class Fnv1a {
 public:
  void add(const void* data, std::size_t size) {
    const auto* bytes = static_cast<const unsigned char*>(data);
    for (std::size_t i = 0; i < size; ++i) value_ = (value_ ^ bytes[i]) * 0x100000001b3ULL;
  }
  void add(const std::vector<double>& values) { add(values.data(), values.size() * sizeof(double)); }
  template <class T>
  void addValue(const T& value) {
    add(&value, sizeof value);
  }

  // as an archive of procedure_fields.hpp
  template <class T>
  void value(const T& value) {
    addValue(value);
  }
  void vector(const Eigen::Vector3d& v) { add(v.data(), 3 * sizeof(double)); }
  template <class T>
  void numbers(const std::vector<T>& v) {
    addValue(v.size());
    add(v.data(), v.size() * sizeof(T));
  }
  template <class T, class Visit>
  void list(const std::vector<T>& items, Visit visit) {
    addValue(items.size());
    for (const T& item : items) visit(item);
  }

  std::uint64_t result() const { return value_; }

 private:
  std::uint64_t value_ = 0xcbf29ce484222325ULL;
};

}  // namespace

std::uint64_t hash(const State& state) {
  Fnv1a h;
  h.addValue(state.step);
  h.addValue(state.seed);
  h.addValue(state.random);
  for (const auto* v : {&state.x, &state.y, &state.z, &state.vx, &state.vy, &state.vz, &state.ax, &state.ay, &state.az,
                        &state.qw, &state.qx, &state.qy, &state.qz, &state.wx, &state.wy, &state.wz})
    h.add(*v);
  h.addValue(state.gas_amount);
  h.addValue(state.pressure);
  h.addValue(state.volume);
  h.addValue(state.pressure_reached);
  h.add(state.joints.data(), sizeof state.joints);
  for (const GripPoint& point : state.grip) {
    h.addValue(point.particle);
    h.add(point.local.data(), 3 * sizeof(double));
  }
  h.addValue(state.helix_pressed);
  h.addValue(state.in_contact);
  h.addValue(state.untouched_time);
  h.addValue(state.grip_force);
  visitProcedure(h, state.procedure);
  if (state.pull.holds())
    visitPullSpring(h, state.pull);  // without a hand the hash is what it was before there were hands
  h.add(state.solver.linearization_point.data(), state.solver.linearization_point.size() * sizeof(float));
  h.add(state.solver.next.data(), state.solver.next.size() * sizeof(float));
  h.addValue(state.solver.steps);
  h.addValue(state.solver.elastic_energy);
  h.addValue(state.solver.rest_steps);
  h.addValue(state.solver.due);
  h.addValue(state.solver.usual_length);
  h.addValue(state.solver.recovery_steps);
  h.addValue(state.solver.fallback);
  return h.result();
}

}  // namespace vibe
