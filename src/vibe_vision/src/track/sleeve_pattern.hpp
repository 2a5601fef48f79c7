#pragma once

#include <cstddef>

#include "track/blurred_line.hpp"
#include "track/cut_stripe.hpp"
#include "vibe_vision/track/marker_pattern.hpp"

namespace vibe::vision {

/// A printed cylinder seen by a pinhole camera. A pixel looks at one place of the print, (u, phi); around it, the print
/// is a picture of straight edges whose slope against the axis depends on the row, so that the blur in both directions
/// is a blur along the axis with a variance that grows with the slope. What is left are two tables along a line: bars,
/// and one period of the stripe, which rotation shifts. Only the ends of the stripe need more; see CutStripe.
class SleevePattern : public MarkerPattern {
 public:
  SleevePattern(const SleeveDesign& design, double pixels_per_metre, const MarkerView& view);

  std::array<bool, kPoseParameters> observes() const override;
  Eigen::Vector2d window(const MarkerPose& pose, double motion) const override;
  Eigen::Vector2d maxWindow() const override { return Eigen::Vector2d(half_length_, radius_) * 1.2; }
  double rim() const override { return half_length_; }
  void prepare(const MarkerPose& pose, const MarkerMotion& motion, bool rough = false) override;
  void evaluate(const MarkerPose& pose, const PixelBlock& pixels, PatternValues& values) override;
  void select(const MarkerPose& pose, double motion, PixelBlock& pixels) const override;
  double searchHalfWidth() const override;
  void searchProfile(double motion, double scale, std::vector<float>& profile) const override;
  void searchTurns(double motion, double scale, std::vector<float>& cosine, std::vector<float>& sine) const override;
  std::vector<double> rotationGuesses() const override;

 private:
  struct View;
  struct Part;
  struct Blackness;
  View viewOf(const MarkerPose& pose, double motion) const;
  Eigen::Vector2d printWindow(const MarkerPose& pose, double motion) const;
  void compose(MovingLine& line, double low, double high, double half_motion) const;
  void measureEdges(const std::vector<Interval>& bars);
  void mark(Part& part) const;
  void placePixels(const View& view, const PixelBlock& pixels, std::size_t begin, Part& part) const;
  void place(const View& pose, const float* along, const float* lateral, Part& part) const;
  void unroll(const View& pose, Part& part) const;
  void spread(const View& pose, Part& part) const;
  void look(Part& part) const;
  void cutAt(std::size_t i, Part& part) const;
  Blackness bentCutAt(std::size_t i, Part& part) const;
  Blackness exactCutAt(const Part& part, std::size_t i) const;
  void chain(const View& view, std::size_t begin, const Part& part, PatternValues& values) const;
  Blackness stripeAt(const Part& part, std::size_t i) const;
  Blackness cutStripeAt(const Part& part, std::size_t i, float cut) const;
  Blackness plainCutAt(const Part& part, std::size_t i, float phase, float sign, float out) const;
  Blackness roughCutAt(const Part& part, std::size_t i, float sign, float out) const;
  Blackness stripeWithin(const Part& part, std::size_t i, float phase, float sign, float out, float black) const;
  static void add(const Blackness& other, float weight, Blackness& sum);

  MarkerView view_;
  double radius_, half_length_;  ///< [px]
  float helix_begin_, helix_end_, pitch_;
  std::vector<float> edge_distance_;  ///< from an edge of a bar, at every pixel from -half_length_ on [px]
  BlurredLine bars_, stripe_;
  MovingLine moving_bars_, moving_stripe_;
  CutStripe cut_;
  double motion_ = 0;     ///< of prepare() [px],
  double turn_ = 0;       ///< likewise, to the side of the motion [rad]
  MotionParts parts_{0};  ///< of prepare()
  bool rough_ = false;
};

/// A pose, ready for use.
struct SleevePattern::View {
  float along, lateral, rotation;
  float tilt_cosine, tilt_sine, inverse_scale;
  float slant_cosine, slant_sine;
  float bend;  ///< of the line of sight per pixel: 1 / focal length; also 1 / distance to the camera [1/px]
  float slope_along, slope_across;  ///< of the line of sight to the centre, along and across the tilted marker
  float turn_cosine, turn_sine;     ///< of the angle around the rod from the rod's normal to the camera
  float spin;                       ///< by how much half of the motion is longer for the stripe, which turns
  float half_motion;                ///< in pixels of the print, where the camera looks at it at a right angle
  float variance;                   ///< of optics and pixel in pixels of the print, less what a lengthened motion has
  float by_blur;                    ///< relative change of `variance` with the blur [1/px]
};

/// Some pixels. Lengths are in pixels of the print.
struct SleevePattern::Part {
  static constexpr std::size_t kSize = 64;
  std::size_t size = kSize;
  alignas(64) float x[kSize], v[kSize];  ///< along and across in the picture
  alignas(64) float u[kSize], w[kSize];  ///< along the print, from its centre and from a black part's centre
  alignas(64) float rise[kSize];         ///< by how much a place is nearer to the camera than the centre
  alignas(64) float oblique[kSize];      ///< 1 / cosine of the line of sight against the surface, across the rod
  alignas(64) float sine[kSize], cosine[kSize], phi[kSize];    ///< around the rod: from its normal; from the stripe
  alignas(64) float stretch[kSize], lean[kSize], turn[kSize];  ///< change of u along and across, of phi pitch / 2 pi
  alignas(64) float by_slant[kSize];                           ///< change of u
  alignas(64) float half_motion[kSize], stripe_half_motion[kSize];
  alignas(64) float bar_variance[kSize], stripe_variance[kSize], cut_variance[kSize];
  alignas(64) float inside[kSize], outside[kSize];  ///< of the helix, and of its ends: 1 or 0
  alignas(64) float bars[kSize], bars_slope[kSize], bars_bend[kSize];
  alignas(64) float stripe[kSize], stripe_slope[kSize], stripe_bend[kSize];
  alignas(64) int tells[kSize];  ///< 1: the pixel is near an edge
  alignas(64) float value[kSize], by_u[kSize], by_w[kSize], by_blur[kSize];
};

/// Blackness and its derivatives: by a shift of all, by a shift of the stripe alone, and by the relative change of the
/// blur's variance.
struct SleevePattern::Blackness {
  float value = 0, by_u = 0, by_w = 0, by_blur = 0;
};

}  // namespace vibe::vision
