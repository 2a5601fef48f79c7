#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <array>
#include <vector>

#include "solver/attachment_columns.hpp"
#include "solver/constraint_rows.hpp"
#include "sparse/factor.hpp"
#include "suture/capstan.hpp"

namespace vibe {

/// Block elimination (Woodbury) of a few constraints and of the gas, with the vectors half solved: for A = L Lt a row j
/// becomes Z = L^-1 j, sparse because it lives on the elimination tree's paths of its nodes, and the compliance between
/// rows is Z^T Z. Columns of nodes are kept until the factor changes, so that a touched node costs once.
class ConstraintSchur {
 public:
  /// Forgets everything about the old factor.
  void reset(const Factor& factor, int node_count);
  /// @param attachments  points that the threads run between, about the same factor; null without threads. A list that
  ///                     does not begin with the one before needs a reset().
  void setRows(const ConstraintRows& rows, const Factor& factor, const AttachmentColumns* attachments = nullptr);
  /// The gas: force `direction` (4 per node) per pressure, pressure falling by stiffness per volume. stiffness 0: none;
  /// infinite: the volume is prescribed.
  void setGas(const float* direction4, double stiffness, const Factor& factor);

  int rowCount() const { return row_count_; }
  /// Given y = L^-1 (right-hand side), finds the forces of rows and gas so that the rows' values of the solution are
  /// `rhs` (equations) or at least that (contacts and threads), and adds them to y. Threads slide where friction does
  /// not hold them.
  /// @param swelling  change of volume where it is prescribed [m^3]
  void eliminate(const Eigen::Ref<const Eigen::VectorXd>& rhs, double swelling, float* y);
  const Eigen::VectorXd& forces() const { return force_; }
  double gasForce() const { return gas_force_; }
  /// How far the values of the rows that act move in the solution: `rhs`, less what compliance leaves, plus what
  /// threads slid [m].
  const Eigen::VectorXd& moves() const { return moves_; }
  /// Thread that slid out of a row into the next row of its thread [m].
  double slid(int row) const { return slid_[row]; }
  /// From now on until setRows() threads do not slide.
  void holdThreads();
  /// Compliance between rows, gas taken into account (rows x rows) [m/N].
  const Eigen::MatrixXd& compliance() const { return compliance_; }

 private:
  static constexpr int kMaxSlots = 384;
  /// A row as the elimination sees it: in slots, which are nodes or attachment points whose columns are known.
  struct SlotRow {
    std::vector<int> slot;
    std::vector<Eigen::Vector3d> coefficient;
    double compliance = 0;
  };
  struct Contact {
    int first = 0;  // of inequalities_: normal, two tangents
    double friction = 0;
  };
  struct Thread {
    int first = 0, count = 0;  // of inequalities_
    Eigen::VectorXd capstan;
    ThreadSlide slide;
  };
  void makeRoom(const ConstraintRows& rows, std::size_t attachment_count);
  int slotOf(int key, const Factor& factor, const AttachmentColumns* attachments);
  void setRow(int row, const LinearForm& form, double compliance, const Factor& factor);
  void setRow(int row, int attachment, const Eigen::Vector3d& along, double compliance, const Factor& factor,
              const AttachmentColumns* attachments);
  void setThreadRows(const ThreadRows& thread, const Factor& factor, const AttachmentColumns* attachments);
  void sortRows(const ConstraintRows& rows);
  void addThread(const ThreadRows& thread);
  void setYield(const ConstraintRows& rows);
  const Eigen::Matrix3f& gram(int a, int b);
  void findUsedSlots();
  void findRowValues(const float* y);
  void addForces(float* y);
  void formCompliance();
  double complianceBetween(int i, int j);
  void formBlocks();
  void solveContacts();
  double sweepContacts(Eigen::VectorXd& force);
  double sweepThread(Thread& thread, Eigen::VectorXd& force);
  void solveRows();
  void solveEquations();

  int node_count_ = 0;
  std::vector<int> slot_of_key_;  // of nodes, then of attachment points
  std::vector<int> key_of_slot_;
  std::vector<HalfColumns> columns_;
  std::vector<Eigen::Matrix3f> gram_;  // of slots a >= b, row after row
  std::vector<char> gram_known_;
  const AttachmentColumns* attachments_ = nullptr;
  int row_count_ = 0;  // of rows_, which keep their memory
  std::vector<SlotRow> rows_;
  std::vector<int> used_slots_;
  std::vector<Eigen::Vector3f> seen_;  // per slot: a vector's value at the node, or the rows' force on it
  Eigen::VectorXd row_value_;
  std::vector<int> equations_;     // row numbers: those of equations, then of springs
  std::vector<int> inequalities_;  // row numbers: normals and tangents of contacts, then pulls of threads
  std::vector<Contact> contacts_;
  std::vector<Thread> threads_;
  int thread_count_ = 0;
  bool yields_ = false;
  YieldMatrix tool_compliance_;
  Eigen::Matrix<double, kYieldDofs, Eigen::Dynamic> yield_, given_;  // per row: of its target; compliance times this
  std::vector<float> gas_;                                           // L^-1 of the gas direction
  double gas_stiffness_ = 0, gas_norm2_ = 0;
  Eigen::VectorXd gas_row_, force_, moves_, slid_;
  double gas_force_ = 0;
  Eigen::MatrixXd compliance_, block_, cross_, schur_, coupling_;  // of equations, with contacts, of contacts
  Eigen::VectorXd residual_, equation_residual_, contact_residual_, equation_force_, contact_force_, thread_residual_;
  Eigen::LDLT<Eigen::MatrixXd> equation_factor_;
};

}  // namespace vibe
