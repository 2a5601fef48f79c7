#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <vector>

#include "vibe_sim/sparse/factor.hpp"

namespace vibe {

/// One row of the few conditions beside the big system: sum of coefficient . d at the nodes.
struct HalfRow {
  std::vector<int> node;
  std::vector<Eigen::Vector3d> coefficient;
  double compliance = 0;
  double friction = -1;  ///< below 0: an equation; 0 and above: the normal row of a contact, two tangents follow
};

/// Block elimination (Woodbury) of a few conditions and of the gas, with the vectors half solved: for A = L Lt a row j
/// becomes Z = L^-1 j, sparse because it lives on the elimination tree's paths of its nodes, and the compliance between
/// rows is Z^T Z. Columns of nodes are kept until the factor changes, so that a touched node costs once.
class HalfSpace {
 public:
  /// Forgets everything about the old factor.
  void reset(const Factor& factor, int node_count);
  void setRows(const std::vector<HalfRow>& rows, const Factor& factor);
  /// The gas: force `direction` (4 per node) per pressure, pressure falling by stiffness per volume. stiffness 0: none;
  /// infinite: the volume is prescribed.
  void setGas(const float* direction4, double stiffness, const Factor& factor);

  int rowCount() const { return row_count_; }
  /// Given y = L^-1 (right-hand side), finds the forces of rows and gas so that the rows' values of the solution are
  /// `wanted` (rows that are equations) or at least that (contacts), and adds them to y.
  /// @param swelling  wanted change of volume where it is prescribed [m^3]
  void eliminate(const Eigen::Ref<const Eigen::VectorXd>& wanted, double swelling, float* y);
  const Eigen::VectorXd& forces() const { return force_; }
  double gasForce() const { return gas_force_; }
  /// Compliance between rows, gas taken into account (rows x rows) [m/N].
  const Eigen::MatrixXd& compliance() const { return compliance_; }

 private:
  static constexpr int kMostSlots = 384;
  int slotOf(int node, const Factor& factor);
  const Eigen::Matrix3f& gram(int a, int b);
  void findUsedSlots();
  void findRowValues(const float* y);
  void addForces(float* y);
  void formCompliance();
  double complianceBetween(int i, int j);
  void formBlocks();
  void solveContacts();
  void solveRows();
  void solveEquations();

  std::vector<int> slot_of_node_;
  std::vector<int> node_of_slot_;
  std::vector<HalfColumns> columns_;
  std::vector<Eigen::Matrix3f> gram_;  // of slots a >= b, row after row
  std::vector<char> gram_known_;
  int row_count_ = 0;  // of rows_ and row_slots_, which keep their memory
  std::vector<HalfRow> rows_;
  std::vector<std::vector<int>> row_slots_;
  std::vector<int> used_slots_;
  std::vector<Eigen::Vector3f> seen_;  // per slot: a vector's value at the node, or the rows' force on it
  Eigen::VectorXd row_value_;
  std::vector<int> equations_, contacts_;  // row numbers; contacts: of normals and tangents alike
  std::vector<float> gas_;                 // L^-1 of the gas direction
  double gas_stiffness_ = 0, gas_norm2_ = 0;
  Eigen::VectorXd gas_row_, force_;
  double gas_force_ = 0;
  Eigen::MatrixXd compliance_, block_, cross_, schur_, coupling_;  // of equations, with contacts, of contacts
  Eigen::VectorXd lack_, equation_lack_, contact_lack_, equation_force_, contact_force_;
  Eigen::LDLT<Eigen::MatrixXd> equation_factor_;
};

}  // namespace vibe
