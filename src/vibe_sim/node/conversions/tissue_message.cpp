#include "conversions/tissue_message.hpp"

#include <algorithm>
#include <cstring>

#include "conversions/conversions.hpp"

namespace vibe::sim {

namespace {

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

}  // namespace

ParticleCloud::ParticleCloud(const Model& model, const State& start, std::uint32_t revision)
    : strain_(static_cast<std::size_t>(model.particle_count)), with_marks_(!start.procedure.dose.empty()) {
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
  message_.height = 1;
  message_.width = static_cast<std::uint32_t>(model.particle_count);
  message_.point_step = static_cast<std::uint32_t>(with_marks_ ? sizeof(Point) : kPlainBytes);
  message_.row_step = message_.width * message_.point_step;
  message_.is_dense = true;
  message_.data.resize(message_.row_step);
  for (std::uint32_t i = 0; i < message_.width; ++i) {
    Point point{};
    point.id = i;
    point.revision = revision;
    point.region = static_cast<std::uint8_t>(model.organ.region[i]);
    std::memcpy(&message_.data[i * message_.point_step], &point, message_.point_step);
  }
}

const sensor_msgs::PointCloud2& ParticleCloud::update(const Model& model, const State& state, std::int64_t stamp) {
  message_.header.stamp = toRosTime(stamp);
  model.tissue->strain(state, strain_.data());
  for (std::size_t i = 0; i < strain_.size(); ++i) {
    const float moving[4] = {static_cast<float>(state.x[i]), static_cast<float>(state.y[i]),
                             static_cast<float>(state.z[i]), strain_[i]};
    static_assert(sizeof moving == kMovingBytes);
    std::memcpy(&message_.data[i * message_.point_step], moving, sizeof moving);
  }
  if (with_marks_) updateMarks(state.procedure);
  return message_;
}

void ParticleCloud::updateMarks(const ProcedureState& procedure) {
  const std::size_t count = std::min(procedure.dose.size(), procedure.grade.size());
  for (std::size_t i = 0; i < std::min<std::size_t>(count, message_.width); ++i) {
    std::uint8_t* point = &message_.data[i * message_.point_step];
    point[offsetof(Point, grade)] = procedure.grade[i];
    std::memcpy(point + offsetof(Point, thermal_dose), &procedure.dose[i], sizeof(float));
  }
}

}  // namespace vibe::sim
