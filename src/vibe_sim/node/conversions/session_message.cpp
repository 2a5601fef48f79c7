#include "conversions/session_message.hpp"

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <string>

#include "conversions/conversions.hpp"
#include "conversions/procedure_message.hpp"
#include "conversions/tool_message.hpp"
#include "vibe_core/arithmetic/machine.hpp"
#include "vibe_core/program/error.hpp"
#include "vibe_core/scene/scene_parser.hpp"
#include "vibe_core/simulation/simulator.hpp"
#include "vibe_core/simulation/snapshot.hpp"
#include "vibe_core/state/state_fields.hpp"

namespace vibe::sim {
namespace {

void addTool(const Observation& seen, const TimedSimulation& simulation, vibe_msgs::StepResult& message) {
  std::copy(seen.joints.begin(), seen.joints.end(), message.joints.begin());
  message.tip.position = toMessage<geometry_msgs::Point>(seen.tip);
  message.helix.position = toMessage<geometry_msgs::Point>(seen.helix);
  message.tip.orientation = message.helix.orientation = toQuaternion(seen.tip_turn);
  message.wrench = makeWrench(simulation.state(), 0).wrench;
}

void addSituation(const Observation& seen, const State& state, vibe_msgs::StepResult& message) {
  message.pressure = seen.pressure;
  message.pressure_reached = seen.pressure_reached;
  message.held_particles = static_cast<std::uint32_t>(state.grip.size());
  message.arm_closed = seen.arm_closed;
  message.needle_on_arm = seen.needle_on_arm;
  message.needle_loaded = seen.needle_loaded;
  message.sutures = static_cast<std::uint32_t>(seen.sets);
  message.bites = static_cast<std::uint32_t>(seen.bites);
  message.stage = static_cast<std::uint8_t>(seen.stage);
  message.tension = seen.tension;
}

std::size_t offsetOf(const std::string& name, const sensor_msgs::PointCloud2& cloud) {
  const auto found = std::find_if(cloud.fields.begin(), cloud.fields.end(), [&name](const auto& field) {
    return field.name == name && field.datatype == sensor_msgs::PointField::FLOAT32;
  });
  if (found == cloud.fields.end()) throw Error("a cloud without a field '" + name + "' of type FLOAT32 shows no wall.");
  return found->offset;
}

}  // namespace

std_msgs::String makeSceneText(const Scene& scene, std::uint64_t seed) {
  Scene whole = scene;
  whole.seed = seed;
  if (!whole.geometry.file.empty()) whole.geometry.file = std::filesystem::absolute(whole.geometry.file).string();
  std_msgs::String text;
  text.data = toYaml(whole);
  return text;
}

vibe_msgs::StageTime makeStageTime(const std::string& name, const DurationHistogram& durations) {
  vibe_msgs::StageTime message;
  message.name = name;
  message.p50 = 1e3 * durations.quantile(0.5);
  message.p99 = 1e3 * durations.quantile(0.99);
  message.max = 1e3 * durations.max();
  return message;
}

void setWork(const StepReport& report, vibe_msgs::StepTiming& message) {
  const auto seconds = [&report](StepStage stage) {
    return static_cast<float>(report.stage_times[static_cast<std::size_t>(stage)]);
  };
  message.stage_loads = seconds(StepStage::Loads);
  message.stage_factor = seconds(StepStage::Factor);
  message.stage_energy = seconds(StepStage::Energy);
  message.stage_inverse = seconds(StepStage::Inverse);
  message.stage_rows = seconds(StepStage::Rows);
  message.stage_paths = seconds(StepStage::Paths);
  message.stage_walls = seconds(StepStage::Walls);
  message.stage_other = seconds(StepStage::Other);
  message.iterations = report.iterations;
  message.evaluations = report.evaluations;
  message.rows = report.rows;
  message.wall_pairs = report.wall_pairs;
  message.arrived = report.arrived ? 1 : 0;
  message.fallback = report.fallback ? 1 : 0;
}

vibe_msgs::SessionInfo makeSessionInfo(const TimedSimulation& simulation) {
  const Model& model = simulation.model();
  const MachineInfo machine = machineInfo();
  auto message = stamped<vibe_msgs::SessionInfo>(simulation.now());
  message.run = simulation.run();
  message.revision = simulation.revision();
  message.version = machine.version;
  message.state_version = kStateVersion;
  message.compiler = machine.compiler;
  message.c_library = machine.c_library;
  message.os = machine.os;
  message.processor = machine.processor;
  message.cores = static_cast<std::uint32_t>(machine.cores);
  message.instruction_set = machine.instruction_set;
  message.arithmetic = machine.arithmetic;
  message.urdf = simulation.urdf();
  message.urdf_hash = hash(message.urdf);
  message.scene = makeSceneText(model.scene, simulation.seed()).data;
  message.scene_hash = hash(message.scene);
  message.model_hash = modelFingerprint(model);
  message.session = simulation.session();
  return message;
}

vibe_msgs::StateSnapshot makeStateSnapshot(const TimedSimulation& simulation) {
  auto message = stamped<vibe_msgs::StateSnapshot>(simulation.now());
  message.run = simulation.run();
  message.step = static_cast<std::uint64_t>(simulation.state().step);
  const std::string bytes = encodeSnapshot(simulation.model(), simulation.state());
  message.data.assign(bytes.begin(), bytes.end());
  message.session = simulation.session();
  return message;
}

vibe_msgs::StepResult makeStepResult(const TimedSimulation& simulation, bool whole) {
  const Observation seen = observe(simulation.simulation(), false);  // the wall is in tissue/particles
  auto message = stamped<vibe_msgs::StepResult>(simulation.now(), kWorldFrame);
  message.step = static_cast<std::uint64_t>(seen.step);
  message.time = seen.time;
  message.revision = simulation.revision();
  message.has_particles = whole || hasImage(simulation.simulation());
  addTool(seen, simulation, message);
  addSituation(seen, simulation.state(), message);
  for (const Event& event : simulation.events())
    if (event.kind != Event::Kind::Warning) message.events.push_back(makeEvent(event, simulation.now()));
  return message;
}

Observation readStepResult(const vibe_msgs::StepResult& message) {
  Observation seen;
  seen.step = static_cast<std::int64_t>(message.step);
  seen.time = message.time;
  std::copy(message.joints.begin(), message.joints.end(), seen.joints.begin());
  seen.tip = toVector(message.tip.position);
  const auto& q = message.tip.orientation;
  seen.tip_turn.coeffs() << q.x, q.y, q.z, q.w;
  seen.helix = toVector(message.helix.position);
  seen.force = toVector(message.wrench.force);
  seen.pressure = message.pressure;
  seen.pressure_reached = message.pressure_reached;
  seen.grips = message.held_particles > 0;
  seen.arm_closed = message.arm_closed;
  seen.needle_on_arm = message.needle_on_arm;
  seen.needle_loaded = message.needle_loaded;
  seen.sets = static_cast<int>(message.sutures);
  seen.bites = static_cast<int>(message.bites);
  seen.stage = static_cast<Suture::Stage>(message.stage);
  seen.tension = message.tension;
  for (const vibe_msgs::ProcedureEvent& event : message.events) {
    Event& perceived = seen.events.emplace_back();
    perceived.kind = static_cast<Event::Kind>(event.kind);
    perceived.time = seen.time;
    perceived.particle = event.particle;
    perceived.value = event.value;
  }
  return seen;
}

std::vector<Eigen::Vector3d> readWall(const sensor_msgs::PointCloud2& cloud) {
  const std::array<std::size_t, 3> offsets{offsetOf("x", cloud), offsetOf("y", cloud), offsetOf("z", cloud)};
  const std::size_t count = cloud.width * cloud.height;
  if (cloud.data.size() < count * cloud.point_step ||
      *std::max_element(offsets.begin(), offsets.end()) + 4 > cloud.point_step)
    throw Error("a cloud of " + std::to_string(cloud.data.size()) + " bytes is too short for its points.");
  std::vector<Eigen::Vector3d> wall(count);
  for (std::size_t i = 0; i < count; ++i)
    for (int axis = 0; axis < 3; ++axis) {
      float value = 0;
      std::memcpy(&value, &cloud.data[i * cloud.point_step + offsets[axis]], sizeof value);
      wall[i][axis] = value;
    }
  return wall;
}

}  // namespace vibe::sim
