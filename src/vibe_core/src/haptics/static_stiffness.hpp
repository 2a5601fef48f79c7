#pragma once

#include <memory>
#include <vector>

#include "solver/constraint_schur.hpp"
#include "solver/elastic_body.hpp"

namespace vibe {

/// The stiffness of a body about some positions, without inertia, and what a few rows feel of it.
class StaticStiffness {
 public:
  StaticStiffness(const ElasticBody& body, std::shared_ptr<const BlockPattern> pattern,
                  std::shared_ptr<const FactorPlan> plan);

  /// Factors the stiffness about positions (3 * nodes) [m]; empty: rest. Costs tens of step times.
  /// @returns false where it is not positive definite; the object is then unusable until the next success
  bool make(const std::vector<float>& positions);
  /// The gas: force per pressure (4 per node) [m^2], how fast the pressure falls with the volume [Pa/m^3]; 0: none.
  void setGas(const std::vector<float>& direction4, double stiffness);
  /// Equations only; columns of nodes seen before cost nothing.
  void setRows(const ConstraintRows& rows);

  /// Compliance between the rows [m/N].
  const Eigen::MatrixXd& compliance() const { return schur_.compliance(); }
  /// The mass that moves along when the rows' values are moved slowly: T^T M T with T the displacements for each column
  /// of `motion` (rows x modes), as Guyan reduction has it [kg].
  Eigen::MatrixXd movingMass(const Eigen::MatrixXd& motion);

 private:
  const ElasticBody& body_;
  BlockMatrix matrix_;
  Factor factor_;
  ConstraintSchur schur_;
  std::vector<double> displacement_;
  std::vector<float> half_;
};

}  // namespace vibe
