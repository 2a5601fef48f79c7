#pragma once

#include <cstdint>
#include <ostream>
#include <string>
#include <vector>

#include "contact/contact_run.hpp"
#include "vibe_core/solver/step_policy.hpp"

namespace vibe::benchmarks {

/// What a state does with one policy.
struct PolicyTrace {
  std::vector<Eigen::Vector3d> force;                ///< on the tool, or tension of the last thread, per step [N]
  std::vector<Eigen::Matrix3d> stiffness;            ///< of the tool's impedance, per step; 0 without one [N/m]
  std::vector<std::vector<Eigen::Vector3d>> points;  ///< particles, or tips that were aimed, per step [m]
  int steps = 0;
  long iterations = 0;     ///< of all steps
  long evaluations = 0;    ///< of the elastic energy
  int solved_again = 0;    ///< steps solved more than once
  int fallback = 0;        ///< steps solved by backward Euler
  std::uint64_t bits = 0;  ///< hash of all states, forces and impedances
};

/// What a shift of a number changes, over all states.
struct PolicyEffect {
  double factor = 1, value = 0;          ///< of the number
  std::vector<std::string> states;       ///< in which any bit changes; empty: no effect in these states
  double force = 0;                      ///< largest change over the largest force of the state
  double motion_rms = 0;                 ///< over particles and steps, of the state where it is largest [m]
  double motion_max = 0;                 ///< [m]
  double stiffness = 0;                  ///< largest change over the largest stiffness of the state
  long iterations = 0, evaluations = 0;  ///< in all states, minus those with the defaults
  int solved_again = 0, fallback = 0;    ///< likewise
};

/// Runs all states with the defaults, and again with one number shifted at a time.
class PolicyStudy {
 public:
  /// @param scene  coarse, see policyStates()
  PolicyStudy(const Scene& scene, const std::string& urdf, std::ostream& log);

  /// What it is to multiply a number by a factor; the policy is that of before afterwards.
  PolicyEffect effectOf(const PolicyNumber& number, double factor) const;

  /// Sum of the states with the defaults; no forces and points.
  PolicyTrace total() const;

 private:
  std::vector<PolicyTrace> runAll() const;

  std::vector<ContactCase> states_;
  std::shared_ptr<const Model> scope_;
  std::vector<PolicyTrace> defaults_;
};

/// One row: name of the number, factor, and the effect. CSV.
void writePolicyHeader(std::ostream& out);
void writePolicyTotal(const PolicyTrace& total, std::ostream& out);
void writePolicyEffect(const PolicyNumber& number, const PolicyEffect& effect, std::ostream& out);

/// Short motions in which the numbers of the policy act: the wall pressed, swept along and rammed by the scope, a fold
/// that is wound in, one that meets others while the gas leaves, a set that is cinched.
/// @param scene  with gas, scope, helix and suture; coarse, so that a run takes a second or two
/// @param urdf   text of the scene's tool
std::vector<ContactCase> policyStates(const Scene& scene, const std::string& urdf, std::ostream& log);

/// Names of the states, one line each, for the program's help.
std::string describePolicyStates();

}  // namespace vibe::benchmarks
