#pragma once

#include <array>
#include <vector>

#include <Eigen/Core>

#include "vibe_core/solver/body_loads.hpp"

namespace vibe {

/// A linear function of positions: sum of coefficient . x at the nodes. Node vectors are 4 numbers per node.
struct LinearForm {
  std::vector<int> node;
  std::vector<Eigen::Vector3d> coefficient;

  void setNode(int at, const Eigen::Vector3d& direction) {
    node.assign(1, at);
    coefficient.assign(1, direction);
  }
  void setPoint(const SurfacePoint& point, const Eigen::Vector3d& direction);
  void setPoint(const AttachmentPoint& point, const Eigen::Vector3d& direction);
  double value(const std::vector<double>& position4) const;
  /// Adds a force along the form.
  void addForce(double force, std::vector<float>& vector4) const;
};

/// The form has a value, up to what its compliance leaves.
struct EquationRow {
  LinearForm form;
  double compliance = 0;                    ///< 0: exact [m/N]
  YieldVector yield = YieldVector::Zero();  ///< motion of the value per motion of the tool that yields
};

/// A point of the surface outside the tool with Coulomb friction: the form of the normal, which is at least its target,
/// and those of two tangents.
struct ContactRows {
  std::array<LinearForm, 3> form;
  std::array<Eigen::Vector3d, 3> direction;  ///< normal, two tangents; unit
  double friction = 0;                       ///< Coulomb coefficient
  std::array<double, 3> guess{};             ///< forces with which the solve begins [N]
  std::size_t load = 0;                      ///< its index in the loads
  double target = 0;                         ///< of the normal, of one that does not count [m]
  double compliance = 0;                     ///< of the normal [m/N]
  /// Motion of the three targets per motion of the tool that yields.
  Eigen::Matrix<double, 3, kYieldDofs> yield = Eigen::Matrix<double, 3, kYieldDofs>::Zero();
};

/// A segment of thread between two attachment points that follow each other.
struct SegmentRows {
  /// Its length, negative: it pulls, and never pushes.
  LinearForm pull;
  Eigen::Vector3d along = Eigen::Vector3d::Zero();  ///< coefficient of `pull` at the first point; at the second: -along
  double compliance = 0;                            ///< of the thread [m/N]
  /// Two springs across it: a tense segment resists being turned. The potential has their energy and force; the
  /// elimination adds the effect of their stiffness.
  std::array<LinearForm, 2> turn;
  std::array<Eigen::Vector3d, 2> across;
  double turn_compliance = 0;  ///< [m/N]
  /// Of the part of their stiffness that the factor does not have; 0: it has enough of it [m/N].
  double turn_missing = 0;
  double spare = 0;    ///< thread that may slide out of it [m]
  double capstan = 1;  ///< largest ratio of the tensions of this segment and the next
};

struct ThreadRows {
  int first_row = 0;         ///< pulls of all segments, then two turns per segment
  int first_attachment = 0;  ///< point at the start of the first segment
  RowList<SegmentRows> segments;

  int count() const { return static_cast<int>(segments.size()); }
  int pullRow(int segment) const { return first_row + segment; }
  int turnRow(int segment, int turn) const { return first_row + count() + 2 * segment + turn; }
};

/// The few constraints beside the big system of a step. Every form has a row number, under which vectors over rows
/// have their entry: equations, then three per contact that counts, then the threads.
struct ConstraintRows {
  RowList<EquationRow> equations;
  RowList<ContactRows> contacts;  ///< from `counted` on beyond the budget of a step, without rows and force
  std::size_t counted = 0;
  RowList<ThreadRows> threads;
  /// Of the tool: its motion is minus this times the sum over rows of yield * force. Zero: the tool is rigid.
  YieldMatrix tool_compliance = YieldMatrix::Zero();
  bool tool_yields = false;

  void clear();
  /// Sets the first rows of the threads.
  /// @param contacts_that_count  the first ones
  void number(std::size_t contacts_that_count);
  void number() { number(contacts.size()); }
  int count() const;
  int contactRow(std::size_t contact) const { return static_cast<int>(equations.size() + 3 * contact); }
  /// Forms of the rows whose forces are unknowns of the solver, in the order of rows: use(row, form).
  template <class Use>
  void forEachMultiplier(Use use) const {
    int row = 0;
    for (const EquationRow& equation : equations) use(row++, equation.form);
    for (std::size_t c = 0; c < counted; ++c)
      for (const LinearForm& form : contacts[c].form) use(row++, form);
    for (const ThreadRows& thread : threads)
      for (int k = 0; k < thread.count(); ++k) use(thread.pullRow(k), thread.segments[k].pull);
  }
  /// Rows that move with a tool that yields: use(row, yield).
  template <class Use>
  void forEachYield(Use use) const {
    if (!tool_yields) return;
    int row = 0;
    for (const EquationRow& equation : equations) use(row++, equation.yield);
    for (std::size_t c = 0; c < counted; ++c)
      for (int k = 0; k < 3; ++k) use(row++, contacts[c].yield.row(k).transpose());
  }
  /// Forms of the rows whose energy the potential has: use(row, form, compliance).
  template <class Use>
  void forEachSpring(Use use) const {
    for (const ThreadRows& thread : threads)
      for (int k = 0; k < thread.count(); ++k)
        for (int j = 0; j < 2; ++j)
          use(thread.turnRow(k, j), thread.segments[k].turn[j], thread.segments[k].turn_compliance);
  }
};

class ConstraintSchur;

/// Unknowns of QuasiNewton beside those of the tissue: how far rows give way to their own forces, because a tool
/// yields, or a contact or a thread has a compliance. Where they give way by p = -C f, they have the energy
/// p C^-1 p / 2. All is kept as the forces f, those on the degrees of freedom of the tool and then one per row: so C
/// may be singular, and the scalar product of a move with a change of gradient is f C g.
class RowUnknowns {
 public:
  /// Pairs of moves and changes of the gradient. Liu et al. 2017
  /// (doi 10.1145/2990496) keep five above a fixed factor.
  static constexpr int kHistory = 6;

  /// No row has given way. Keeps its buffers.
  /// @param rows  must live until the next begin()
  void begin(const ConstraintRows& rows);

  /// Before the first loop over pairs, with the forces of the last elimination.
  void beginDirection(const ConstraintSchur& schur);
  /// Share of pair i in the scalar product of its move and the gradient.
  double gradientTerm(int i) const { return product(pair_[static_cast<std::size_t>(i)], left_); }
  /// The first loop takes `part` of the change of pair i from the gradient.
  void subtract(int i, double part);
  /// Makes rows' targets for the tissue of those that the first loop leaves.
  void addTargets(Eigen::VectorXd& rhs) const { addMotion(-1, taken_, rhs); }
  /// The direction of the elimination.
  /// @param moves  out: how far the rows' values move in it, beyond what the rows give way
  void setDirection(const ConstraintSchur& schur, Eigen::VectorXd& moves);
  /// Share of pair i in the scalar product of its change and the direction.
  double directionTerm(int i) const { return product(pair_[static_cast<std::size_t>(i)], direction_); }
  /// The second loop takes `part` of the move of pair i from the direction.
  /// @param moves  those of setDirection(), without what threads slide in that part from now on
  void reduce(int i, double part, Eigen::VectorXd& moves);

  /// From how far rows are from their targets without forces to how far they are now.
  void addDisplacement(Eigen::VectorXd& rhs) const { addMotion(-1, force_, rhs); }
  /// Takes a part of the direction.
  void move(double part);
  /// Thread that slid out of each row since begin(), into others of its thread [m].
  const Eigen::VectorXd& lost() const { return lost_; }
  /// The same in the direction [m].
  double loss(int row) const { return loss_[row]; }
  /// As if so much had slid out of a row [m].
  void lose(int row, double length) { lost_[row] += length; }
  /// Gives way by the forces of the last elimination in addition.
  void push(const ConstraintSchur& schur);
  /// Energy, and its slope, after a part of the direction [J].
  double energy(double part) const;
  double slope(double part) const { return product(force_, direction_) + part * product(direction_, direction_); }
  /// Scalar product of the pair that a part of the direction makes.
  double curvature(double part) const { return part * part * product(direction_, direction_); }
  void forgetOldest();
  void keep(int i, double part);

 private:
  using Forces = Eigen::VectorXd;  // kYieldDofs, then one per row
  void setForces(const ConstraintSchur& schur, Forces& forces) const;
  double product(const Forces& a, const Forces& b) const;
  void addMotion(double sign, const Forces& forces, Eigen::VectorXd& values) const;

  const ConstraintRows* rows_ = nullptr;
  Eigen::VectorXd compliance_;  // of each row by itself
  Forces force_, direction_;
  Forces left_, taken_;  // of the gradient, in the first loop
  Forces last_;          // of the last elimination
  std::array<Forces, kHistory> pair_;
  Eigen::VectorXd lost_, loss_;  // thread, per row: since begin(), in the direction
  std::array<Eigen::VectorXd, kHistory> pair_loss_;
};

}  // namespace vibe
