#pragma once
#include <Eigen/Core>

#include "vibe_vision/track/marker_pattern.hpp"

namespace vibe::vision {

/// How the light changes around a rod: a factor, 1 on the mean, at places across its picture and linear in between.
/// Paper on a rod is darker where it is turned away from the lamp (Lambert), which no slope describes. The lamp stays
/// where it is when the rod moves, so that frames are averaged. A glossy or wet rod also mirrors the lamp in a line
/// along it, which is added to black and white alike.
class RodLight {
 public:
  /// @param radius  of the rod [px]; 0: nothing round, the light stays even
  explicit RodLight(double radius) : radius_(radius) { reset(); }

  bool isRound() const { return radius_ > 0; }
  bool known() const { return known_; }
  bool shines() const { return shines_; }  ///< a lamp is mirrored
  static constexpr int kPlaces = 13;       ///< over 0.96 of the radius to both sides
  using Vector = Eigen::Matrix<double, kPlaces, 1>;
  using Lights = Eigen::MatrixXd;
  /// The marker is there now.
  void moveTo(const MarkerPose& pose) { rows_ = placed_ ? rows_ : rowsOf(pose); }
  /// That it is smooth and known to a standard deviation, as normal equations of a relative change of the factors.
  void addPrior(double deviation, Eigen::Ref<Lights> left, Eigen::Ref<Vector> right) const;
  /// Changes the factors, relative to what they are.
  void change(const Vector& by) { factor_.array() *= (1 + by.array()).max(0.5); }
  /// Of a pixel, since the light was learnt: 0 to kPlaces - 1.
  float placeOf(float along, float lateral) const { return rows_.at(along, lateral); }
  void reset();
  /// From all pixels of a window: the print has the same mean in every row, whatever its place and rotation.
  void guess(const MarkerPose& pose, const PixelBlock& pixels);
  /// Fills PixelBlock::light and PixelBlock::sheen. @param count  pixels, a multiple of kLanes
  void shine(const MarkerPose& pose, PixelBlock& pixels, std::size_t count) const;

  /// Least squares from pixels, smooth, and near what was known: begin(), add() for each, learn().
  void begin(const MarkerPose& pose);
  /// @param plain  grey value in even light; weight: inverse variance
  void add(double along, double lateral, double value, double plain, double weight);
  void learn();
  /// After another response of the camera was found: grey values are powers of what they were.
  /// @return the factor of the sheen, about
  double raise(double power);

 private:
  using Both = Eigen::Matrix<double, 2 * kPlaces, 1>;  ///< the light and the sheen
  using Matrix = Eigen::Matrix<double, 2 * kPlaces, 2 * kPlaces>;
  struct Rows {
    float along, lateral, cosine, sine, per_pixel;
    /// Place in units of the spacing, 0 to kPlaces - 1.
    float at(float x, float y) const {
      const float p = ((y - lateral) * cosine - (x - along) * sine) * per_pixel + (kPlaces - 1) / 2;
      return p < 0 ? 0 : (p > kPlaces - 1.001F ? kPlaces - 1.001F : p);
    }
  };
  Rows rowsOf(const MarkerPose& pose) const;
  void guessSheen(const PixelBlock& pixels);
  void solve(const Vector& near, double information);

  double radius_;
  bool known_ = false;
  bool shines_ = false;  ///< there is a sheen
  bool placed_ = false;  ///< the sheen was seen at rows_, but the marker has not been fitted there
  double level_ = 0;     ///< mean grey value [DN]
  Rows rows_{};
  Vector factor_, sheen_;
  Both right_;
  Matrix left_;
};

}  // namespace vibe::vision
