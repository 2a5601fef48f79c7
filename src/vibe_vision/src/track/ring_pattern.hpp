#pragma once
#include "track/float_sums.hpp"
#include "track/ring_table.hpp"
#include "vibe_vision/track/marker_pattern.hpp"

namespace vibe::vision {

/// A flat black ring on white.
class RingPattern : public MarkerPattern {
 public:
  RingPattern(const RingDesign& design, double pixels_per_metre);

  std::array<bool, kPoseParameters> observes() const override;
  Eigen::Vector2d window(const MarkerPose& pose, double motion) const override;
  Eigen::Vector2d maxWindow() const override;
  void prepare(const MarkerPose& pose, double motion, bool rough = false) override;
  void evaluate(const MarkerPose& pose, const PixelBlock& pixels, PatternValues& values) override;
  void select(const MarkerPose& pose, double motion, PixelBlock& pixels) const override;
  double searchHalfWidth() const override;
  void searchProfile(double motion, double scale, std::vector<float>& profile) const override;

 private:
  /// The table's place and its value and derivatives there, for each pixel of a part of the block.
  struct Part;
  void place(const MarkerPose& pose, const PixelBlock& pixels, std::size_t begin, Part& part) const;
  void readTable(Part& part) const;
  void chain(const MarkerPose& pose, std::size_t begin, const Part& part, PatternValues& values) const;

  double inner_, outer_, half_side_;  ///< [px]
  RingTable table_;
};

}  // namespace vibe::vision
