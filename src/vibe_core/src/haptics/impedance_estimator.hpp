#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "arithmetic/ordered_algebra.hpp"
#include "haptics/static_stiffness.hpp"
#include "threads/background_worker.hpp"
#include "vibe_core/haptics/tool_impedance.hpp"
#include "vibe_core/solver/step_policy.hpp"
#include "vibe_core/state/impedance_memory.hpp"

namespace vibe {

/// Corrects a stiffness along the latest motion to the change of force that was observed along it: with the step s and
/// the loss of force y, K - K s (K s)^T / (s^T K s) + y y^T / (s^T y), the update of Broyden, Fletcher, Goldfarb and
/// Shanno (Nocedal, Wright 2006, Numerical Optimization, eq. 6.19). K stays symmetric and positive semidefinite, and
/// K s becomes y. The pair is kept for the frames in which the tool rests.
template <int N>
class SlopeCorrection {
 public:
  using Vector = Eigen::Matrix<double, N, 1>;
  using Matrix = Eigen::Matrix<double, N, N>;

  /// @param memory  of the past frames; must outlive this
  explicit SlopeCorrection(SlopeMemory<N>& memory)
      : memory_(memory),
        position_(memory.place.data()),
        force_(memory.force.data()),
        step_(memory.step.data()),
        change_(memory.change.data()) {}

  void forget() { memory_.known = memory_.has_pair = false; }

  /// @param position  of the tool
  /// @param force   elastic part, at `position`
  /// @param usable  the step from the last position to this one is long enough, and the same nodes are touched
  void observe(const Matrix& stiffness, const Vector& position, const Vector& force, bool usable) {
    if (memory_.known && usable) keepPair(stiffness, position - position_, force_ - force);
    memory_.known = true;
    position_ = position;
    force_ = force;
  }

  Matrix corrected(const Matrix& stiffness) const {
    const Vector pulled = stiffness * step_;
    const double expected = fixedDot(step_, pulled);
    if (!memory_.has_pair || !(expected > 0)) return stiffness;
    return stiffness - pulled * pulled.transpose() / expected +
           change_ * change_.transpose() / fixedDot(step_, change_);
  }

  Vector lastPosition() const { return position_; }

 private:
  void keepPair(const Matrix& stiffness, const Vector& step, const Vector& change) {
    const Vector pulled = stiffness * step;
    const double expected = fixedDot(step, pulled), observed = fixedDot(step, change);
    const StepPolicy& policy = stepPolicy();
    if (!(observed >= policy.haptic_least_slope * expected && observed <= policy.haptic_most_slope * expected &&
          observed > 0))
      return;
    step_ = step;
    change_ = change;
    memory_.has_pair = true;
    // The units of the components differ; the roots of the stiffnesses make them comparable.
    const Vector scale = stiffness.diagonal().cwiseMax(0).cwiseSqrt();
    double step2 = 0, change2 = 0;
    for (int i = 0; i < N; ++i) {
      step2 += scale[i] * scale[i] * step[i] * step[i];
      if (scale[i] > 0) change2 += change[i] * change[i] / (scale[i] * scale[i]);
    }
    const double most_skew = policy.haptic_most_skew;
    const bool skew = !(step2 * change2 <= most_skew * most_skew * observed * observed);
    if (skew || (scale.array() == 0).any()) change_ = pulled * (observed / expected);  // its size along the step only
  }

  SlopeMemory<N>& memory_;
  Eigen::Map<Vector> position_, force_, step_, change_;
};

/// Where the tool acts on the tissue in one direction.
struct ToolRow {
  SurfacePoint surface;
  double compliance = 0;                          ///< between the tool and the point [m/N]
  Eigen::Vector3d direction;                      ///< unit
  Eigen::Matrix<double, 1, kToolMotions> motion;  ///< how its target moves with each of the tool's motions
  const AttachmentPoint* patch = nullptr;         ///< instead of `surface`, during the step; null: none
};

/// The tool in the tissue in one step.
struct ToolContactRows {
  std::vector<ToolRow> rows;                     ///< in force; empty: near, but nothing is touched
  Eigen::Matrix<double, kToolMotions, 1> place;  ///< scope_tip [m] and joints [m], [rad] where the forces hold
  Eigen::Matrix<double, kToolMotions, 1> speed;  ///< of the same, per second
  Eigen::Matrix<double, kToolMotions, 1> force;  ///< tissue on tool [N], and its efforts on the joints [N], [N m]
  bool contacts = false;                         ///< some rows are contacts
  bool smooth = true;                            ///< false: an exceptional step, whose force is no use for slopes
};

/// Estimates a ToolImpedance, by equations (21) and (23) of docs/computation.md:
///   C = J K^-1 J^T + diag(c),  K_tool = P^T C^-1 P,  F = F0 - K_tool (x - x0) - B (v - v0)
///   J, c    rows of the wall that the tool acts on, and their compliances [m/N]
///   K       static stiffness of the wall, without inertia; K_tool is corrected by SlopeCorrection (22)
///   P       how the targets of the rows move with the tool: kToolMotions columns, translations and joints
///   F, x, v force on the tool, its position and speed; B = c_K K_tool + c_M M_tool with the mass that moves along
///           (Guyan 1965, "Reduction of stiffness and mass matrices")
/// K is renewed in the background every haptic_interval, less often where a factor takes more than its share of
/// operations (kFactorRate). Time is counted in
/// steps and the past is in an ImpedanceMemory, so that the results depend neither on the speed of threads nor on what
/// an estimator has done before: its members are caches of what the memory names.
class ImpedanceEstimator {
 public:
  /// @param rest  of the body; may be shared
  ImpedanceEstimator(const ElasticBody& body, double step_period, const RestStiffness& rest);

  /// One step in which the tool is near tissue.
  /// @param step           its number; after the time between two renewals without a step near tissue a new touch
  /// begins
  /// @param positions      of the nodes [m]
  /// @param gas_direction  volume gradient (4 per node) [m^2]
  /// @param gas_stiffness  [Pa/m^3]; 0: none
  /// @param memory         of the steps before, and of this one afterwards
  /// @returns nothing where nothing is touched
  std::optional<ToolImpedance> update(std::int64_t step, const ToolContactRows& touch,
                                      const std::array<const double*, 3>& positions,
                                      const std::vector<float>& gas_direction, double gas_stiffness,
                                      ImpedanceMemory& memory);

 private:
  using Motions = Eigen::Matrix<double, kToolMotions, kToolMotions>;
  using JointMatrix = Eigen::Matrix<double, kScopeJointCount, kScopeJointCount>;
  using MotionVector = Eigen::Matrix<double, kToolMotions, 1>;

  /// A stiffness as its basis says.
  struct Made {
    std::uint64_t id = 0;  // of the basis; 0: nothing
    std::unique_ptr<StaticStiffness> stiffness;
    bool usable = false;             // it is positive definite
    Motions mass = Motions::Zero();  // moving along [kg], [kg m], [kg m^2]
  };

  static void begin(std::int64_t step, const std::vector<float>& gas_direction, double gas_stiffness,
                    ImpedanceMemory& memory);
  void renew(const ToolContactRows& touch, const std::array<const double*, 3>& positions,
             const std::vector<float>& gas_direction, double gas_stiffness, ImpedanceMemory& memory);
  void provide(const ImpedanceMemory& memory);
  void provideAtRest(const ImpedanceBasis& basis);
  void finishNext();
  void makeInBackground(const ImpedanceBasis& basis, const std::vector<int>& nodes);
  void make(const ImpedanceBasis& basis, const std::vector<int>& nodes, Made& out) const;
  bool farFrom(const std::vector<float>& linearization_point, const std::array<const double*, 3>& positions) const;
  void setRows(const ToolContactRows& touch);
  MotionVector calmForce(const ToolContactRows& touch, const Eigen::Matrix3d& k_tip, const Eigen::Matrix3d& b_tip,
                         const JointMatrix& k_joints, const JointMatrix& b_joints, ImpedanceMemory& memory) const;
  std::optional<ToolImpedance> respond(const ToolContactRows& touch, bool consecutive, ImpedanceMemory& memory);
  ToolImpedance response(const ToolContactRows& touch, const Motions& stiffness, bool comparable,
                         ImpedanceMemory& memory);

  const ElasticBody& body_;
  int interval_;                 // steps
  Made rest_, current_, next_;   // `rest_` serves bases without positions
  Made* present_ = nullptr;      // of the memory's current basis; null: not usable
  ImpedanceBasis next_basis_;    // read by `making_`
  std::vector<int> next_nodes_;  // likewise
  ConstraintRows rows_;
  Eigen::MatrixXd motion_;  // (rows x kToolMotions)
  Eigen::MatrixXd solved_;  // force of each row per motion (rows x kToolMotions)
  OrderedLdlt factor_;      // of the rows' compliance
  std::vector<int> nodes_;
  BackgroundWorker making_;  // of next_; the last member, because it works on the others
};

}  // namespace vibe
