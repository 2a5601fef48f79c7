#pragma once
#include <Eigen/Core>
#include <memory>
#include <optional>
#include <vector>

#include "vibe_core/metrics/smoothness.hpp"

namespace vibe {

/// Measures of the motion of a point. A measure that the motion so far does not define has no value.
struct MotionMeasures {
  double time = 0;                   ///< recorded [s]
  double movement_time = 0;          ///< spent in movements [s]
  double idle_time = 0;              ///< time - movement_time [s]
  double path_length = 0;            ///< of the polygon through all positions given [m]
  double max_speed = 0;              ///< over one sample period [m/s]
  int movements = 0;                 ///< number that have begun
  int submovements = 0;              ///< peaks of the speed without tremor, see PeakCounter
  std::optional<double> mean_speed;  ///< path_length / time [m/s]
  std::optional<double> economy;     ///< straight distances of movements over path lengths, 0 to 1; higher is better
  std::optional<double> log_dimensionless_jerk;  ///< see logDimensionlessJerk(), mean over movements by duration
  std::optional<double>
      spectral_arc_length;  ///< SPARC, dimensionless: see SpectralArcLength, mean over movements by duration
};

/// Smoothness of one movement from the jerk of its speed v(t),
///   LDLJ = -ln(T^3 / v_peak^2 * integral_0^T (d2v / dt2)^2 dt),
/// negative in practice; higher, that is nearer to 0, is smoother: Hogan & Sternad 2009, J Mot Behav 41(6):529;
/// Balasubramanian et al. 2015, J NeuroEng Rehabil 12:112. By second differences and T = samples * period, as in the
/// authors' published program. A minimum-jerk reach has -ln(204.8) = -5.32, whatever its length and duration.
/// @param speed   evenly sampled [m/s] or [rad/s]
/// @param period  of the samples [s]
/// @return no value for a standstill, for a speed without jerk beyond rounding, or for less than three samples
std::optional<double> logDimensionlessJerk(const std::vector<double>& speed, double period);

struct MotionSettings {
  double sample_period = 1.0 / 60;  ///< speeds are means over at least this time [s]
  double rest_reach = 1e-3;  ///< a point that stays this near for rest_time is at rest [m]; design choice, above tremor
  double rest_time = 0.25;   ///< [s]; design choice
  double tremor_period = 0.1;  ///< rest is looked for in the mean position over this time [s]; tremor is at 8 to 12 Hz
};

/// Measures the motion of a point as it happens. Call add() once per step, measures() whenever wanted, finish() when a
/// session or a phase ends; add() may go on after it, and the way from the last position to the next does not count.
///
/// What is exact and what is not: time and path length are sums over all steps. Everything else is from the velocity
/// averaged over the least number of whole steps that is not shorter than sample_period, so that 60 Hz and 1 kHz give
/// the same but for the averaging. The length of the first step sets this grid; should later ones differ, positions are
/// interpolated between them, which counts as jerk (a reach in steps of 2 to 14 ms has an LDLJ lower by 2), while the
/// rest hardly notices.
///
/// A movement lasts from rest to rest. The point is at rest while its place without tremor (the mean over
/// tremor_period) stays within rest_reach of where it was rest_time ago. It begins where the speed was last below a
/// twentieth of rest_reach / rest_time and ends where it first is again, both within rest_time of where the point left
/// or entered rest. Smoothness and economy count when a movement has ended. A movement of more than kLongestMovement
/// samples (34 s at 60 Hz) is measured in pieces of that length and counts once.
///
/// Memory is bounded and asked for when made. A step costs less than a microsecond, the end of a movement 20 us
/// after 2 s and 0.4 ms after 34 s (the spectrum). Copies share the tables of the spectrum: use them in one thread.
class MotionRecorder {
 public:
  static constexpr int kLongestMovement = 2048;  ///< samples

  /// @param spectrum  tables to share among recorders of one thread (1.4 MB each); nothing: its own
  explicit MotionRecorder(const MotionSettings& settings = {}, std::shared_ptr<SpectralArcLength> spectrum = nullptr);

  /// @param position  at the end of the step [m]. The first after the start or finish() is where the record begins.
  /// @param dt        length of the step [s]
  /// @throws Error, and changes nothing, if a position or a time is not finite or a time is not positive
  void add(const Eigen::Vector3d& position, double dt);

  /// Ends the record at the last position: a movement that is going on ends there, and counts.
  void finish();

  /// Of the whole motion so far, on both sides of every finish().
  MotionMeasures measures() const;

 private:
  void begin(const Eigen::Vector3d& position, double dt);
  void sample(const Eigen::Vector3d& point);
  Eigen::Vector3d steadied(const Eigen::Vector3d& point);
  bool atRest() const;
  double slowSpeed() const;
  int firstSlow(int from, int to) const;
  void beginMovement();
  void endMovement();
  void measure(int samples);
  void drop(int samples);

  MotionSettings settings_;
  std::shared_ptr<SpectralArcLength> spectrum_;
  double period_ = 0;     // of the grid; 0 before the first position [s]
  bool started_ = false;  // there is a last position
  Eigen::Vector3d last_ = Eigen::Vector3d::Zero();
  double since_sample_ = 0;  // [s]
  MotionMeasures sums_;      // times, path, counts
  PeakCounter peaks_;

  int window_ = 0;  // samples in rest_time
  bool moving_ = false;
  std::vector<double> speed_;            // of the movement, or of the last rest_time before one
  std::vector<Eigen::Vector3d> points_;  // where these samples begin, and where the last ends
  std::vector<Eigen::Vector3d> steady_;  // points_ without tremor
  std::vector<Eigen::Vector3d> recent_;  // the last points, in a ring
  std::size_t oldest_ = 0;               // of them
  std::vector<double> piece_;            // what measure() measures

  double jerk_sum_ = 0, jerk_time_ = 0;
  double arc_sum_ = 0, arc_time_ = 0;
  double straight_sum_ = 0, way_sum_ = 0;
};

}  // namespace vibe
