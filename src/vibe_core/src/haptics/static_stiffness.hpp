#pragma once

#include <memory>
#include <vector>

#include "solver/constraint_schur.hpp"
#include "vibe_core/solver/elastic_body.hpp"

namespace vibe {

/// The stiffness of a body at given positions, without inertia, and the compliance of a few rows.
class StaticStiffness {
 public:
  StaticStiffness(const ElasticBody& body, std::shared_ptr<const BlockPattern> pattern,
                  std::shared_ptr<const FactorPlan> plan);

  /// Factors the stiffness at positions (3 * nodes) [m]; empty: rest. Costs tens of step times.
  /// @returns false where it is not positive definite; the object is then unusable until the next success
  bool make(const std::vector<float>& positions);
  /// The gas. direction4: force per pressure (4 per node) [m^2]; stiffness: fall of pressure per volume [Pa/m^3], 0:
  /// none.
  void setGas(const std::vector<float>& direction4, double stiffness);
  /// Sets the rows, all equations. Nodes that had rows before cost nothing.
  void setRows(const ConstraintRows& rows);

  /// Compliance between the rows [m/N].
  const Eigen::MatrixXd& compliance() { return schur_.compliance(); }
  /// The mass that moves along when the rows' values are moved slowly, by Guyan reduction: T^T M T, with T the
  /// displacements for each column of `motion` (rows x modes) [kg].
  Eigen::MatrixXd movingMass(const Eigen::MatrixXd& motion);

 private:
  const ElasticBody& body_;
  BlockMatrix matrix_;
  Factor factor_;
  ColumnCache columns_;
  ConstraintSchur schur_;
  std::vector<double> displacement_;
  std::vector<float> half_;
};

}  // namespace vibe
