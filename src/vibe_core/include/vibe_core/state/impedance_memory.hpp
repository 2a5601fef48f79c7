#pragma once
#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include "vibe_core/input/step_input.hpp"

namespace vibe {

/// Three translations of the tool, then the joints of the scope.
constexpr int kToolMotions = 3 + kScopeJointCount;

/// What one static stiffness of the tool impedance is computed from. The factor itself is a cache.
struct ImpedanceBasis {
  std::uint64_t id = 0;              ///< hash of the members below; 0: there is none
  std::vector<float> positions;      ///< linearization point (3 * nodes) [m]; empty: rest
  std::vector<float> gas_direction;  ///< volume gradient (4 * nodes) [m^2]
  double gas_stiffness = 0;          ///< [Pa/m^3]; 0: no gas
  // rows for the mass that moves along; empty: no mass
  std::vector<int> node;                   ///< (rows)
  std::vector<Eigen::Vector3d> direction;  ///< (rows) unit
  std::vector<std::array<double, kToolMotions>>
      row_motion;  ///< (rows) move of the row's target per tool motion [m/m], [m/rad]
};

/// What SlopeCorrection keeps of the last frames, for N motions.
template <int N>
struct SlopeMemory {
  bool known = false;              ///< `place` and `force` are those of the last frame
  bool has_pair = false;           ///< `step` and `change` are a pair
  std::array<double, N> place{};   ///< of the tool [m], [rad]
  std::array<double, N> force{};   ///< elastic part there [N], [N m]
  std::array<double, N> step{};    ///< a move of the tool [m], [rad]
  std::array<double, N> change{};  ///< loss of force along it [N], [N m]
};

/// What the estimate of the tool impedance carries from step to step. Output depends on it, positions and forces do
/// not.
struct ImpedanceMemory {
  std::int64_t last_step = std::numeric_limits<std::int64_t>::max();  ///< near tissue; max: there was none
  std::int64_t next_renewal = 0;                                      ///< step at which `next` takes over
  ImpedanceBasis current;                                             ///< of the stiffness in use
  ImpedanceBasis next;                                                ///< of the stiffness in the making
  std::vector<int> last_nodes;                                        ///< touched in the last frame
  bool has_last = false;                                              ///< the members below are those of the last frame
  std::array<double, kToolMotions> last_place{};                      ///< [m], [rad]
  std::array<double, kToolMotions> last_speed{};                      ///< [m/s], [rad/s]
  std::array<double, kToolMotions> last_force{};                      ///< [N], [N m]
  std::array<double, kToolMotions> last_jump{};  ///< of the force, beyond what stiffness explains [N], [N m]
  SlopeMemory<3> slope;                          ///< of the translations
  SlopeMemory<kScopeJointCount> joint_slope;     ///< of the joints
};

}  // namespace vibe
