#pragma once
#include <Eigen/Core>
#include <optional>

namespace vibe {

/// Measures of a force over time.
struct ForceMeasures {
  double time = 0;                    ///< that was recorded [s]
  double loaded_time = 0;             ///< with a force above noise [s]
  double time_above = 0;              ///< with a force above the threshold [s]
  double max = 0;                     ///< [N]
  double impulse = 0;                 ///< integral of the magnitude over time [N s]
  std::optional<double> mean;         ///< over loaded_time; no value without load [N]
  std::optional<double> share_above;  ///< time_above / time; no value without time [1]
};

struct ForceSettings {
  /// Forces above it count in time_above [N]. Default: Trejos et al. 2011, Surg Endosc 25:186: instruments in
  /// transgastric procedures in pigs pushed with more than 5 N in 1.6 % of the samples, with almost 8 N at most.
  double threshold = 5;
  double noise = 1e-6;  ///< smaller forces count as none [N]; design choice
};

/// Accumulates the measures of a force. Call add() once per step; it costs a few additions and does not allocate. With
/// the mean over the step as input all measures are exact except the maximum, which a mean lowers.
class ForceRecorder {
 public:
  /// @throws Error if a setting is negative or not finite
  explicit ForceRecorder(const ForceSettings& settings = {});

  /// @param force  mean over the step, in any frame [N]
  /// @param dt     length of the step [s]
  /// @throws Error, and changes nothing, if the force or the time is not finite or the time is not positive
  void add(const Eigen::Vector3d& force, double dt) { add(force.norm(), dt); }

  /// The same for a magnitude, such as the tension of a thread [N].
  void add(double magnitude, double dt);

  ForceMeasures measures() const;

 private:
  ForceSettings settings_;
  ForceMeasures sums_;
  double loaded_impulse_ = 0;  // [N s]
};

}  // namespace vibe
