#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "arithmetic/ordered_algebra.hpp"
#include "solver/column_cache.hpp"
#include "solver/constraint_rows.hpp"
#include "solver/contact_problem.hpp"
#include "solver/half_rows.hpp"
#include "solver/thread_slides.hpp"
#include "vibe_core/sparse/factor.hpp"
#include "vibe_core/threads/thread_pool.hpp"

namespace vibe {

/// Block elimination (Woodbury) of a few constraints and of the gas, with the vectors half solved: for A = L Lt a row j
/// becomes Z = L^-1 j, sparse because it lives on the elimination tree's paths of its nodes, and the compliance between
/// rows is Z^T Z.
class ConstraintSchur {
 public:
  /// @param thread_guesses  see ThreadSlides
  explicit ConstraintSchur(int thread_guesses = ThreadSlides::kGuesses) : thread_slides_(thread_guesses) {}
  /// What follows is done by a pool, which must outlive that. The bits do not depend on it.
  void use(ThreadPool& pool) { pool_ = &pool; }
  /// Forgets everything about the old factor.
  void reset(const Factor& factor);
  /// @param cache  about the same factor, with the attachment points that the threads run between; it must live until
  ///               the next setRows() or reset(). It may be shared and keeps what it learns.
  void setRows(const ConstraintRows& rows, const Factor& factor, ColumnCache& cache);
  /// The gas: force `direction` (4 per node) per pressure, pressure falling by stiffness per volume. stiffness 0: none;
  /// infinite: the volume is prescribed.
  void setGas(const float* direction4, double stiffness, const Factor& factor);

  int rowCount() const { return rows_.count(); }
  /// Given y = L^-1 (right-hand side), finds the forces of rows and gas so that the rows' values of the solution are
  /// `rhs` (equations) or at least that (contacts and threads), and adds them to y. Threads slide where friction does
  /// not hold them.
  /// @param swelling  change of volume where it is prescribed [m^3]
  void eliminate(const Eigen::Ref<const Eigen::VectorXd>& rhs, double swelling, float* y);
  const Eigen::VectorXd& forces() const { return force_; }
  /// Generalised force of the rows' forces on a tool that yields, see ConstraintRows::tool_compliance.
  const YieldVector& pull() const { return pull_; }
  double gasForce() const { return gas_force_; }
  /// How far the values of the rows move in the solution, plus what threads slid: `rhs`, less what compliance leaves,
  /// for the rows that hold [m].
  const Eigen::VectorXd& moves() const { return moves_; }
  /// The row moves to where `rhs` wants it: it is not a contact that opens or slips, nor a slack thread.
  bool holds(int row) const { return holds_[static_cast<std::size_t>(row)] != 0; }
  /// Largest violation of a contact or thread that the last elimination left, by friction in eyelets, too [m].
  double violation() const { return violation_; }
  /// Per row: thread that slid out of it into others of its thread [m].
  const Eigen::VectorXd& lost() const { return lost_; }
  /// Whether threads are kept from sliding, until setRows().
  void holdThreads(bool hold) { threads_held_ = hold; }
  /// Compliance between rows, gas taken into account (rows x rows) [m/N].
  const Eigen::MatrixXd& compliance() {
    formCompliance();
    return compliance_;
  }

 private:
  struct Contact {
    int first = 0;  // of inequalities_: normal; two tangents where there is friction
    double friction = 0;
  };
  double multiplyRows(const float* y, bool with_gas);
  void addForces(float* y);
  void findNodes(const ConstraintRows& rows);
  void addRow(const LinearForm& form, double compliance, const Factor& factor);
  void addContact(const ContactRows& contact, const Factor& factor);
  void addRun(int attachment, const Eigen::Vector3d& along, double compliance);
  void addThreadRows(const ThreadRows& thread);
  void sortRows(const ConstraintRows& rows);
  void setYield(const ConstraintRows& rows);
  void formCompliance();
  void formBlocks();
  void eliminateEquations(Eigen::Index equations, Eigen::Index inequalities);
  void solveContacts();
  void slideThreads();
  void noteSlides();
  void solveRows();
  void solveEquations();

  ThreadPool single_;
  ThreadPool* pool_ = &single_;
  ColumnCache* cache_ = nullptr;  // null: there are no rows
  std::vector<int> nodes_;        // of the rows
  HalfRows rows_;
  bool formed_ = false;         // the compliance is that of the rows and the gas
  bool blocks_formed_ = false;  // what eliminate() makes of it
  bool rows_formed_ = false;    // row_compliance_ is that of the rows
  Eigen::VectorXd row_value_;
  std::vector<int> equations_;     // row numbers: those of equations, then of springs
  std::vector<int> inequalities_;  // row numbers: normals and tangents of contacts, then pulls of threads
  std::vector<int> idle_;          // row numbers of tangents without friction
  std::vector<Contact> contact_list_;
  ContactProblem contacts_;  // of inequalities_
  ThreadSlides thread_slides_;
  int first_pull_ = 0;  // of inequalities_, of the segments of all threads
  bool threads_held_ = false;
  double violation_ = 0;
  std::vector<char> holds_;  // per row
  bool yields_ = false;
  YieldMatrix tool_compliance_;
  YieldVector pull_ = YieldVector::Zero();
  Eigen::Matrix<double, kYieldDofs, Eigen::Dynamic> yield_, given_;  // per row: of its target; compliance times this
  std::vector<float> gas_;                                           // L^-1 of the gas direction
  double gas_stiffness_ = 0, gas_norm2_ = 0;
  Eigen::VectorXd gas_row_, force_, moves_, lost_;
  double gas_force_ = 0;
  Eigen::MatrixXd row_compliance_, compliance_, block_, cross_, coupling_;  // of equations, with contacts
  Eigen::VectorXd residual_, equation_residual_, contact_residual_, equation_force_, contact_force_;
  std::vector<double> thread_lack_;
  OrderedLdlt equation_factor_;
};

}  // namespace vibe
