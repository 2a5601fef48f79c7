#pragma once

#include <ostream>
#include <vector>

#include "fem/case_model.hpp"
#include "fem/fem_case.hpp"
#include "output/result_row.hpp"

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
  std::vector<double> displacements(const MotionView& motion) const;  ///< (nodes * 3)
  /// Whose volume at rest the sample may give.
  double cavity(const Sample& sample, const MotionView& motion, const ElasticBody& body) const;
  double toolForce(const Sample& sample, const MotionView& motion, const ElasticBody& body) const;
  double constraintForce(const Sample& sample, const BodyLoads& loads) const;

  const CaseModel& model_;
  std::vector<std::vector<NodeMean>> means_;  // per sample
  std::vector<NumberTable> tables_;           // per sample
};

/// Runs a case and returns one row per sample: `setting` is the sample, `reference_error` the largest relative error
/// over its levels. Prints the result of each level, and a warning where an equilibrium has lost a symmetry of the
/// case. Appends every value to `values`.
std::vector<ResultRow> runCase(const FemCase& bench_case, std::ostream& log, std::vector<CaseValue>& values);

/// The parts of runCase.
std::vector<ResultRow> runStatic(const FemCase& bench_case, std::ostream& log, std::vector<CaseValue>& values);
std::vector<ResultRow> runTransient(const FemCase& bench_case, std::ostream& log, std::vector<CaseValue>& values);
std::vector<ResultRow> runModes(const FemCase& bench_case, std::ostream& log, std::vector<CaseValue>& values);

/// A row of this case without results.
ResultRow caseRow(const FemCase& bench_case, const std::string& setting, int particles);
/// Relative error, or the value itself if the sample already is a difference; NaN without a reference.
double referenceError(const Sample& sample, std::size_t level, double value);
void printSample(const Sample& sample, std::size_t level, const std::string& at, double value, std::ostream& log);

}  // namespace vibe::benchmarks
