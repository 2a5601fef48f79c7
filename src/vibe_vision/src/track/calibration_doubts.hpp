#pragma once

#include <array>

#include <Eigen/Core>

#include "vibe_vision/track/tracker.hpp"

namespace vibe::vision {

/// How much the picture of a marker is distorted in one way that the model does not have.
struct Distortion {
  double value = 0, variance = 0;  ///< variance 0: the picture does not tell
};

/// The mean of a quantity over many pictures, each by its information; the last ones count most.
struct FadingMean {
  double weight = 0, sum = 0;  ///< information, and its product with the mean

  /// A picture that does not tell adds nothing. @param unit  that the distortion is counted in
  void add(const Distortion& distortion, double unit = 1);
  double mean() const { return weight > 0 ? sum / weight : 0; }
  /// Both the size of the mean and its significance are beyond a limit. @param least  of its size
  /// @param deviations  of the mean [1]
  bool exceeds(double least, double deviations) const;
};

/// What a picture of a moving marker says of such ways.
struct Distortions {
  /// By how many pixels a row of the image further down is moved along the axis.
  Distortion shear;
  /// Of a flat marker: by how much its rim is nearer to the centre along the axis, and further away across it, relative
  /// to its radius. A bent sheet is foreshortened towards its ends, with the cube of the distance. What an aspect or
  /// a size explains, and what all directions share, as a print with much ink, does not count.
  Distortion bend;
  /// By how much the ends of the marker are nearer to the camera than its middle is, against the design, growing with
  /// the square of the distance [px]. It shows where the camera looks at the marker from the side.
  Distortion relief;
  /// By how much a rod is wider where its rotation is 0 and half a turn on than a quarter turn from there, and the same
  /// an eighth of a turn further, relative to its mean radius.
  std::array<Distortion, 2> oval;
};

/// From where a marker is seen.
struct Sight {
  Eigen::Vector2d down;  ///< direction of the image's rows, along and across the axis
  double slope = 0;      ///< of the line of sight against the marker's normal, along the axis
  double per_pixel = 0;  ///< change of it [1/px]
  double radius = 0;     ///< of a rod [px]
};

/// Collects over many frames what speaks against camera and calibration although the marker is tracked.
class CalibrationDoubts {
 public:
  /// @param rows  rows of the image per pixel across the axis, with sign
  explicit CalibrationDoubts(double rows) : rows_(rows) { reset(); }
  void reset();
  void addBend(const Distortion& bend) { bend_.add(bend); }
  void addOval(const std::array<Distortion, 2>& oval);
  /// @param size  of the marker, from its middle [px]. @param slope  of the line of sight, as Sight::slope
  /// @param uneven  by how much other faults of the model may move the ends against the middle [px]
  void addRelief(const Distortion& relief, double size, double slope, double uneven);
  /// @param speed  along the axis [px/s]
  void addShear(const Distortion& shear, double speed);
  /// Of a marker around a rod. @param tilt  that the fit found besides, in the image [rad]
  void addShear(const Distortion& shear, double speed, double tilt, double rotation);
  /// @param stretch  of the motion during the exposure [px]. @param motion  as speed and exposure say [px]
  void addExposure(const Distortion& stretch, double motion) { exposure_.add(stretch, motion); }
  /// @param log_scale  of the marker against its calibrated size. @param log_gamma  of the response against that given
  void addFit(double log_scale, double log_gamma);

  /// What pictures tell of the time between rows, which all markers of a camera share: information [1/s^2] and its
  /// product with the mean [1/s].
  struct RowTime {
    double information = 0, sum = 0;
  };
  /// Of this marker alone, whatever the tilt of its print may be.
  RowTime rowTimeSeen() const;
  /// What the other markers tell.
  void addRowTime(const RowTime& others);

  Doubt doubt() const;
  /// Standard deviation of the place at a speed if the rows of an image are not exposed at the same time [px].
  double shutterError(double speed, int height) const;
  /// The same from what is not known yet about the time between rows; in the unit of speed times s.
  double unknownShutterError(double speed, int height) const;

 private:
  static constexpr int kUnknowns = 4;  ///< time between rows [s]; cosine, sine and mean of the tilt of a sleeve [rad]
  using Vector = Eigen::Matrix<double, kUnknowns, 1>;
  using Matrix = Eigen::Matrix<double, kUnknowns, kUnknowns>;
  /// What is likely if some of the faults are possible.
  struct Explanation {
    Vector mean = Vector::Zero();
    Matrix covariance = Matrix::Zero();
    double chi_squared = 0;  ///< that it explains
  };
  Explanation explain(bool shutter, bool askew) const;
  bool isBent() const;
  bool isOval() const;
  void add(const Vector& by, double value, double variance);
  void solve();

  double rows_;
  Matrix information_;  ///< of the unknowns
  Vector sums_;
  RowTime others_;
  double row_deviation_ = 0;  ///< of the time between rows, whatever else may be wrong [s]
  double row_time_ = 0;       ///< [s]; 0: all rows are exposed at the same time
  bool askew_ = false;
  FadingMean exposure_;  ///< stretch relative to the motion
  std::array<FadingMean, 2> oval_;
  FadingMean bend_, relief_;  ///< relative to the size
  double relief_bias_ = 0;    ///< what other faults of the model add to the sum of relief_
  double log_scale_ = 0, log_gamma_ = 0;
  int fits_ = 0;
};

}  // namespace vibe::vision
