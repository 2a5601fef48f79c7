#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "vibe_core/solver/body_loads.hpp"
#include "vibe_core/solver/row_list.hpp"

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
  double friction = 0;                       ///< Coulomb coefficient [1]
  bool counts = true;                        ///< false: beyond the budget of a step, without force
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
  double capstan = 1;  ///< largest ratio of the tensions of this segment and the next [1]
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
/// have their entry: equations, then three per contact, then the threads.
struct ConstraintRows {
  RowList<EquationRow> equations;
  RowList<ContactRows> contacts;
  RowList<ThreadRows> threads;
  /// Of the tool: its motion is minus this times the sum over rows of yield * force. Zero: the tool is rigid.
  YieldMatrix tool_compliance = YieldMatrix::Zero();
  bool tool_yields = false;

  void clear();
  /// Sets the first rows of the threads.
  void number();
  int count() const;
  int contactRow(std::size_t contact) const { return static_cast<int>(equations.size() + 3 * contact); }
  /// Forms of the rows whose forces are unknowns of the solver, in the order of rows: use(row, form).
  template <class Use>
  void forEachMultiplier(Use use) const {
    int row = 0;
    for (const EquationRow& equation : equations) use(row++, equation.form);
    for (const ContactRows& contact : contacts)
      for (const LinearForm& form : contact.form) use(row++, form);
    for (const ThreadRows& thread : threads)
      for (int k = 0; k < thread.count(); ++k) use(thread.pullRow(k), thread.segments[k].pull);
  }
  /// Rows that move with a tool that yields: use(row, yield).
  template <class Use>
  void forEachYield(Use use) const {
    if (!tool_yields) return;
    int row = 0;
    for (const EquationRow& equation : equations) use(row++, equation.yield);
    for (const ContactRows& contact : contacts)
      for (int k = 0; k < 3; ++k) use(row++, contact.yield.row(k).transpose());
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

}  // namespace vibe
