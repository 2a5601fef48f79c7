#include "fem/case_runner.hpp"

#include <Eigen/Geometry>
#include <cmath>

#include "vibe_core/program/error.hpp"
#include "vibe_core/tissue/shell.hpp"

namespace vibe::benchmarks {
namespace {

const char* const kPlace[3] = {"x", "y", "z"};
const char* const kMove[3] = {"ux", "uy", "uz"};

}  // namespace

CaseProbe::CaseProbe(const CaseModel& model) : model_(model) {
  for (const Sample& sample : model.benchCase().samples) {
    means_.emplace_back();
    tables_.emplace_back();
    for (const auto& point : sample.points) means_.back().push_back(model.at(point));
    if (sample.table.empty()) continue;
    tables_.back() = readTable(sample.table);
    if (sample.kind == SampleKind::Series) continue;
    const NumberTable& table = tables_.back();
    for (const auto& row : table.rows) {
      Eigen::Vector3d place;
      for (int k = 0; k < 3; ++k) place[k] = row[table.column(kPlace[k])];
      means_.back().push_back(model.at(place));
    }
  }
}

Eigen::Vector3d CaseProbe::displacement(const NodeMean& mean, const MotionView& motion) const {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < mean.node.size(); ++i)
    for (int k = 0; k < 3; ++k)
      sum[k] += mean.weight[i] * (motion.x[k][mean.node[i]] - model_.mesh().nodes[mean.node[i]][k]);
  return sum;
}

Eigen::Vector3d CaseProbe::meanDisplacement(std::size_t sample, const MotionView& motion) const {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  const Sample& s = model_.benchCase().samples[sample];
  if (!s.points.empty()) {
    for (const NodeMean& mean : means_[sample]) sum += displacement(mean, motion);
    return sum / static_cast<double>(means_[sample].size());
  }
  const auto& set = model_.set(s.set);
  for (const int n : set) sum += displacement({{n}, {1.0}}, motion);
  return sum / static_cast<double>(set.size());
}

double CaseProbe::tableDifference(std::size_t sample, const MotionView& motion, double level) const {
  const NumberTable& table = tables_[sample];
  double difference = 0, size = 0;
  const int level_column = table.column("level");
  for (std::size_t r = 0; r < table.rows.size(); ++r) {
    if (std::abs(table.rows[r][level_column] - level) > 1e-6 * std::max(1.0, std::abs(level))) continue;
    const Eigen::Vector3d here = displacement(means_[sample][r], motion);
    for (int k = 0; k < 3; ++k) {
      const double wanted = table.rows[r][table.column(kMove[k])];
      if (std::isnan(wanted)) continue;  // no reference for this direction
      difference += (here[k] - wanted) * (here[k] - wanted);
      size += wanted * wanted;
    }
  }
  return size > 0 ? std::sqrt(difference / size) : std::nan("");
}

std::vector<double> CaseProbe::displacements(const MotionView& motion) const {
  const auto& rest = model_.mesh().nodes;
  std::vector<double> out(3 * rest.size());
  for (std::size_t i = 0; i < rest.size(); ++i)
    for (int k = 0; k < 3; ++k) out[3 * i + k] = motion.x[k][i] - rest[i][k];
  return out;
}

double CaseProbe::cavity(const Sample& sample, const MotionView& motion, const ElasticBody& body) const {
  if (body.shell == nullptr)
    throw Error(model_.benchCase().file + ": sample '" + sample.name + "' needs a shell; only it encloses a volume.");
  const std::vector<double> displacement = displacements(motion);
  std::vector<double> gradient(displacement.size());
  const double volume = body.shell->volume(displacement.data(), gradient.data());
  return sample.rest_volume > 0 ? sample.rest_volume + volume - model_.restVolume() : volume;
}

double CaseProbe::toolForce(const Sample& sample, const MotionView& motion, const ElasticBody& body) const {
  const std::vector<double> displacement = displacements(motion);
  std::vector<double> gradient(displacement.size());
  body.elements->evaluate(displacement.data(), gradient.data());
  double sum = 0;
  for (const int i : model_.set(sample.set)) {
    Eigen::Vector3d force = Eigen::Vector3d::Map(gradient.data() + 3 * i) - body.mass[i] * body.gravity;
    if (!body.load.empty()) force -= body.load[i];
    const Eigen::Vector3d place(motion.x[0][i], motion.x[1][i], motion.x[2][i]);
    const bool torque = sample.kind == SampleKind::Torque;
    sum += sample.direction.dot(torque ? Eigen::Vector3d((place - sample.centre).cross(force)) : force);
  }
  return sum;
}

double CaseProbe::constraintForce(const Sample& sample, const BodyLoads& loads) const {
  const FemCase& c = model_.benchCase();
  std::size_t at = 0;
  if (c.cinch) {
    if (sample.kind == SampleKind::Tension) return -loads.constraints[0].force;
    ++at;
  }
  for (const AttachmentPull& pull : c.pulls) {
    if (pull.spot == sample.spot)
      return sample.direction.dot(Eigen::Vector3d(loads.constraints[at].force, loads.constraints[at + 1].force,
                                                  loads.constraints[at + 2].force));
    at += 3;
  }
  throw Error(c.file + ": sample '" + sample.name + "' has no pull or cinch to measure; add one to 'loads'.");
}

double CaseProbe::measure(std::size_t sample, const MotionView& motion, const ElasticBody& body, const BodyLoads& loads,
                          double level) const {
  const Sample& s = model_.benchCase().samples[sample];
  switch (s.kind) {
    case SampleKind::Reaction:
    case SampleKind::Torque:
      return toolForce(s, motion, body);
    case SampleKind::AttachmentForce:
    case SampleKind::Tension:
      return constraintForce(s, loads);
    case SampleKind::Volume:
      return cavity(s, motion, body);
    case SampleKind::Pressure:
    case SampleKind::LimitPressure:
      return loads.gas.pressure;
    case SampleKind::Profile:
    case SampleKind::StaticField:
      return tableDifference(sample, motion, level);
    case SampleKind::Frequency:
      if (model_.benchCase().modes) return std::nan("");
      break;
    default:
      break;
  }
  return s.direction.dot(meanDisplacement(sample, motion));
}

}  // namespace vibe::benchmarks
