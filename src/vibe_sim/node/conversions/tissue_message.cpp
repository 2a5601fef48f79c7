#include "conversions/tissue_message.hpp"

#include <algorithm>
#include <cstring>
#include <limits>

#include "conversions/conversions.hpp"
#include "vibe_core/constraints/breathing.hpp"

namespace vibe::sim {

namespace {

// The numbers on the wire are those of the library.
using Anatomy = vibe_msgs::TissueTopology;
static_assert(same(Region::Cardia, Anatomy::REGION_CARDIA) && same(Region::Fundus, Anatomy::REGION_FUNDUS) &&
              same(Region::Body, Anatomy::REGION_BODY) && same(Region::Antrum, Anatomy::REGION_ANTRUM) &&
              same(Region::Pylorus, Anatomy::REGION_PYLORUS));
static_assert(same(Wall::Anterior, Anatomy::WALL_ANTERIOR) &&
              same(Wall::GreaterCurvature, Anatomy::WALL_GREATER_CURVATURE) &&
              same(Wall::Posterior, Anatomy::WALL_POSTERIOR) &&
              same(Wall::LesserCurvature, Anatomy::WALL_LESSER_CURVATURE));
static_assert(same(End::None, Anatomy::END_NONE) && same(End::Oesophagus, Anatomy::END_OESOPHAGUS) &&
              same(End::Duodenum, Anatomy::END_DUODENUM));

/// One point on the wire.
struct Point {
  float x, y, z;
  float strain;
  std::uint32_t id;
  std::uint32_t revision;
  std::uint8_t region;
  std::uint8_t grade;  // this and the dose only with marks
  std::uint8_t padding[2];
  float thermal_dose;
};
static_assert(sizeof(Point) == 32);
constexpr std::size_t kPlainBytes = offsetof(Point, thermal_dose);
constexpr std::size_t kMovingBytes = 4 * sizeof(float);  // x, y, z, strain come first

sensor_msgs::PointField field(const std::string& name, std::size_t offset, std::uint8_t type) {
  sensor_msgs::PointField result;
  result.name = name;
  result.offset = static_cast<std::uint32_t>(offset);
  result.datatype = type;
  result.count = 1;
  return result;
}

template <typename Enum>
std::vector<std::uint8_t> toBytes(const std::vector<Enum>& values) {
  std::vector<std::uint8_t> bytes(values.size());
  std::transform(values.begin(), values.end(), bytes.begin(), [](Enum v) { return static_cast<std::uint8_t>(v); });
  return bytes;
}

std::vector<std::uint32_t> flatten(const std::vector<std::array<int, 3>>& triangles) {
  std::vector<std::uint32_t> numbers;
  numbers.reserve(3 * triangles.size());
  for (const auto& triangle : triangles) {
    for (int corner : triangle) numbers.push_back(static_cast<std::uint32_t>(corner));
  }
  return numbers;
}

}  // namespace

ParticleCloud::ParticleCloud(const Model& model, const State& start, std::uint32_t revision)
    : strain_(static_cast<std::size_t>(model.particle_count)),
      with_marks_(!start.procedure.dose.empty()),
      with_seen_(model.scene.inspection.has_value()) {
  using Field = sensor_msgs::PointField;
  message_.header.frame_id = kTissueFrame;
  message_.fields = {field("x", offsetof(Point, x), Field::FLOAT32),
                     field("y", offsetof(Point, y), Field::FLOAT32),
                     field("z", offsetof(Point, z), Field::FLOAT32),
                     field("strain", offsetof(Point, strain), Field::FLOAT32),
                     field("id", offsetof(Point, id), Field::UINT32),
                     field("revision", offsetof(Point, revision), Field::UINT32),
                     field("region", offsetof(Point, region), Field::UINT8)};
  if (with_marks_) {
    message_.fields.push_back(field("grade", offsetof(Point, grade), Field::UINT8));
    message_.fields.push_back(field("thermal_dose", offsetof(Point, thermal_dose), Field::FLOAT32));
  }
  const std::size_t bytes = with_marks_ ? sizeof(Point) : kPlainBytes;
  if (with_seen_) message_.fields.push_back(field("first_seen", bytes, Field::FLOAT32));
  message_.height = 1;
  message_.width = static_cast<std::uint32_t>(model.particle_count);
  message_.point_step = static_cast<std::uint32_t>(bytes + (with_seen_ ? sizeof(float) : 0));
  message_.row_step = message_.width * message_.point_step;
  message_.is_dense = !with_seen_;
  message_.data.resize(message_.row_step);
  for (std::uint32_t i = 0; i < message_.width; ++i) {
    Point point{};
    point.id = i;
    point.revision = revision;
    point.region = static_cast<std::uint8_t>(model.organ.region[i]);
    std::memcpy(&message_.data[i * message_.point_step], &point, bytes);
  }
  if (with_seen_) updateSeen(std::vector<float>(message_.width, std::numeric_limits<float>::quiet_NaN()));
}

const sensor_msgs::PointCloud2& ParticleCloud::update(const Model& model, const State& state, std::int64_t stamp,
                                                      const WallCoverage* coverage) {
  message_.header.stamp = toRosTime(stamp);
  model.tissue->strain(state, strain_.data());
  for (std::size_t i = 0; i < strain_.size(); ++i) {
    const float moving[4] = {static_cast<float>(state.x[i]), static_cast<float>(state.y[i]),
                             static_cast<float>(state.z[i]), strain_[i]};
    static_assert(sizeof moving == kMovingBytes);
    std::memcpy(&message_.data[i * message_.point_step], moving, sizeof moving);
  }
  if (with_marks_) updateMarks(state.procedure);
  if (with_seen_ && coverage != nullptr) updateSeen(coverage->firstSeen());
  return message_;
}

// The last field.
void ParticleCloud::updateSeen(const std::vector<float>& first_seen) {
  for (std::size_t i = 0; i < first_seen.size(); ++i)
    std::memcpy(&message_.data[(i + 1) * message_.point_step - sizeof(float)], &first_seen[i], sizeof(float));
}

void ParticleCloud::updateMarks(const ProcedureState& procedure) {
  const std::size_t count = std::min(procedure.dose.size(), procedure.grade.size());
  for (std::size_t i = 0; i < std::min<std::size_t>(count, message_.width); ++i) {
    std::uint8_t* point = &message_.data[i * message_.point_step];
    point[offsetof(Point, grade)] = procedure.grade[i];
    std::memcpy(point + offsetof(Point, thermal_dose), &procedure.dose[i], sizeof(float));
  }
}

vibe_msgs::TissueTopology makeTopology(const Model& model, std::uint32_t revision, std::int64_t stamp) {
  auto message = stamped<vibe_msgs::TissueTopology>(stamp, kTissueFrame);
  message.revision = revision;
  message.name = model.scene.name;
  message.triangles = flatten(model.organ.surface.triangles);
  for (const Eigen::Vector3d& vertex : model.organ.surface.vertices) {
    message.rest_positions.insert(message.rest_positions.end(), vertex.data(), vertex.data() + 3);
  }
  message.region = toBytes(model.organ.region);
  message.wall = toBytes(model.organ.wall);
  message.end = toBytes(model.organ.end);
  for (double thickness : model.organ.thickness) message.thickness.push_back(static_cast<float>(thickness));
  message.render_triangles = flatten(model.render_surface.triangles);
  message.render_offsets.assign(model.render_surface.offsets.begin(), model.render_surface.offsets.end());
  message.render_particles.assign(model.render_surface.particles.begin(), model.render_surface.particles.end());
  message.render_weights = model.render_surface.weights;
  return message;
}

vibe_msgs::OrganMotion makeOrganMotion(const Model& model, const State& state, std::int64_t stamp) {
  auto message = stamped<vibe_msgs::OrganMotion>(stamp);
  message.breath_held = state.motion.held;
  message.breath_held_time = state.motion.held_time;
  const OrganPhases phases = organPhases(model.scene, state);
  message.breath_phase = phases.breath;
  message.wave_phase = phases.wave;
  message.heart_phase = phases.heart;
  if (const auto breathing = breathingOf(model.scene))
    message.breath_shift = -breathingShift(*breathing, breathingTime(state)).z();
  message.muscle_work = state.motion.muscle_work;
  return message;
}

}  // namespace vibe::sim
