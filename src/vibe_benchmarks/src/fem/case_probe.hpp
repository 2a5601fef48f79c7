#pragma once
#include <vector>

#include "fem/case_model.hpp"

namespace vibe::benchmarks {

/// Evaluates the samples of a case on a state.
class CaseProbe {
 public:
  explicit CaseProbe(const CaseModel& model);

  /// The value of a sample; NaN for kinds that a single state does not determine. For tables: the relative difference
  /// sqrt(sum |u - u_ref|^2 / sum |u_ref|^2) over the rows of that level.
  /// @param body, loads  as in the solution: with the dead load of the level and the forces of the conditions
  double measure(std::size_t sample, const MotionView& motion, const ElasticBody& body, const BodyLoads& loads,
                 double level) const;

  /// Displacement of a mean from rest [m].
  Eigen::Vector3d displacement(const NodeMean& mean, const MotionView& motion) const;

 private:
  Eigen::Vector3d meanDisplacement(std::size_t sample, const MotionView& motion) const;
  double tableDifference(std::size_t sample, const MotionView& motion, double level) const;
  double toolForce(const Sample& sample, const MotionView& motion, const ElasticBody& body) const;
  double constraintForce(const Sample& sample, const BodyLoads& loads) const;

  const CaseModel& model_;
  std::vector<std::vector<NodeMean>> means_;  // per sample
  std::vector<NumberTable> tables_;           // per sample
};

}  // namespace vibe::benchmarks
