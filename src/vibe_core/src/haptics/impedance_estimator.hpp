#pragma once

#include <Eigen/Cholesky>
#include <cstdint>
#include <future>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "haptics/slope_correction.hpp"
#include "haptics/static_stiffness.hpp"
#include "vibe_core/haptics/tool_impedance.hpp"

namespace vibe {

/// Three translations of the tool, then the joints of the scope.
constexpr int kToolMotions = 3 + kScopeJointCount;

/// Where the tool acts on the tissue in one direction.
struct ToolRow {
  int node = -1;
  Eigen::Vector3d direction;                      ///< unit
  Eigen::Matrix<double, 1, kToolMotions> motion;  ///< how its target moves with each of the tool's motions
};

/// What one step tells about the tool in the tissue.
struct ToolContactRows {
  std::vector<ToolRow> rows;                     ///< in force; empty: near, but nothing is touched
  Eigen::Matrix<double, kToolMotions, 1> place;  ///< scope_tip [m] and joints [m], [rad] where the forces hold
  Eigen::Matrix<double, kToolMotions, 1> speed;  ///< of the same, per second
  Eigen::Matrix<double, kToolMotions, 1> force;  ///< tissue on tool [N], and its efforts on the joints [N], [N m]
  bool contacts = false;                         ///< some rows are contacts
  bool smooth = true;                            ///< false: an exceptional step; its force says nothing about slopes
};

/// Finds a ToolImpedance from the rows of each step and a stiffness that is renewed in the background.
/// Time in it is counted in steps, so its results do not depend on the speed of threads. Memory from one step to the
/// next: results differ for a moment after a state was loaded; the simulation itself never depends on them.
class ImpedanceEstimator {
 public:
  /// Factors the stiffness at rest: costs tens of step times.
  ImpedanceEstimator(const ElasticBody& body, double step_period);
  ~ImpedanceEstimator();

  /// One step in which the tool is near tissue.
  /// @param step           its number; after 0.25 s without a step near tissue a new touch begins
  /// @param positions      of the nodes [m]
  /// @param gas_direction  volume gradient (4 per node) [m^2]
  /// @param gas_stiffness  [Pa/m^3]; 0: none
  /// @returns nothing where nothing is touched
  std::optional<ToolImpedance> update(std::int64_t step, const ToolContactRows& touch,
                                      const std::array<const double*, 3>& positions,
                                      const std::vector<float>& gas_direction, double gas_stiffness);

 private:
  using Motions = Eigen::Matrix<double, kToolMotions, kToolMotions>;
  using JointMatrix = Eigen::Matrix<double, kScopeJointCount, kScopeJointCount>;
  void begin(std::int64_t step, const std::vector<float>& gas_direction, double gas_stiffness);
  void renew(const ToolContactRows& touch, const std::array<const double*, 3>& positions,
             const std::vector<float>& gas_direction, double gas_stiffness);
  void startMaking(const std::vector<float>& gas_direction, double gas_stiffness);
  bool farFrom(const std::array<const double*, 3>& positions) const;
  void setRows(const ToolContactRows& touch);
  Eigen::Matrix<double, kToolMotions, 1> calmForce(const ToolContactRows& touch, const Eigen::Matrix3d& k_tip,
                                                   const Eigen::Matrix3d& b_tip, const JointMatrix& k_joints,
                                                   const JointMatrix& b_joints);
  std::optional<ToolImpedance> respond(const ToolContactRows& touch, bool consecutive);
  ToolImpedance response(const ToolContactRows& touch, const Motions& stiffness, bool comparable);

  const ElasticBody& body_;
  int interval_;  // steps
  std::unique_ptr<StaticStiffness> rest_, made_, next_;
  StaticStiffness* present_;
  std::vector<float> linearization_point_, next_linearization_point_, next_gas_;  // empty `linearization_point_`: rest
  ConstraintRows rows_, next_rows_;
  Eigen::MatrixXd motion_, next_motion_;        // (rows x kToolMotions)
  Eigen::MatrixXd solved_;                      // force of each row per motion (rows x kToolMotions)
  Eigen::LDLT<Eigen::MatrixXd> factor_;         // of the rows' compliance
  Motions mass_ = Motions::Zero(), next_mass_;  // moving along [kg], [kg m], [kg m^2]
  std::future<bool> making_;
  std::int64_t last_step_ = std::numeric_limits<std::int64_t>::max(), next_renewal_ = 0;
  std::vector<int> nodes_, last_nodes_;
  bool has_last_ = false;  // response
  Eigen::Matrix<double, kToolMotions, 1> last_place_, last_speed_, last_force_, last_jump_;
  SlopeCorrection<3> slope_;
  SlopeCorrection<kScopeJointCount> joint_slope_;
};

}  // namespace vibe
