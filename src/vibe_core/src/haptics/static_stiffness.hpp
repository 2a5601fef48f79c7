#pragma once

#include <memory>
#include <vector>

#include "solver/constraint_schur.hpp"
#include "vibe_core/solver/elastic_body.hpp"

namespace vibe {

/// The stiffness of a body at rest; constant, for many StaticStiffness.
struct RestStiffness {
  /// Costs tens of step times.
  explicit RestStiffness(const ElasticBody& body);

  std::shared_ptr<const FactorPlan> plan;
  std::shared_ptr<const Factor> factor;  // null: it is not positive definite
};

/// The stiffness of a body at given positions, without inertia, and the compliance of a few rows.
class StaticStiffness {
 public:
  /// The stiffness is that about rest, if that has a factor, until the first make(), which asks for the memory of
  /// another factor.
  StaticStiffness(const ElasticBody& body, const RestStiffness& rest);

  /// Factors the stiffness at positions (3 * nodes) [m]; empty: rest. Costs tens of step times.
  /// @returns false where it is not positive definite; the object is then unusable until the next success
  bool make(const std::vector<float>& positions);
  /// The gas. direction4: force per pressure (4 per node) [m^2]; stiffness: fall of pressure per volume [Pa/m^3], 0:
  /// none.
  void setGas(const std::vector<float>& direction4, double stiffness);
  /// Sets the rows, all equations. Nodes that had rows before cost nothing.
  void setRows(const ConstraintRows& rows);

  /// Makes the columns of nodes and their products, which setRows() would make. Nodes may come more than once.
  void prepare(const std::vector<int>& nodes);

  /// Compliance between the rows [m/N].
  const Eigen::MatrixXd& compliance() { return schur_.compliance(); }
  /// The mass that moves along when the rows' values are moved slowly, by Guyan reduction: T^T M T, with T the
  /// displacements for each column of `motion` (rows x modes) [kg].
  Eigen::MatrixXd movingMass(const Eigen::MatrixXd& motion);

 private:
  const ElasticBody& body_;
  struct Own {
    explicit Own(const std::shared_ptr<const FactorPlan>& plan);
    bool make(const ElasticBody& body, const std::vector<float>& positions);

    BlockMatrix matrix;
    std::shared_ptr<Factor> factor;
    std::vector<double> displacement;
  };
  friend RestStiffness;

  std::shared_ptr<const FactorPlan> plan_;
  std::unique_ptr<Own> own_;  // null: there is none yet
  std::shared_ptr<const Factor> factor_;
  ColumnCache columns_;
  ConstraintSchur schur_;
  std::vector<float> half_;
};

}  // namespace vibe
