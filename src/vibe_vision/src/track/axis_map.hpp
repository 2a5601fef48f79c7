#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <opencv2/core.hpp>
#include <vector>

#include "vibe_vision/config/vision_config.hpp"
#include "vibe_vision/image/frame.hpp"
#include "vibe_vision/track/marker_pattern.hpp"

namespace vibe::vision {

/// Sums of grey values over the width of a band, by bins of 1 px along the axis.
struct AxisProfile {
  double first = 0;               ///< middle of the first bin [px]
  std::vector<float> sum, count;  ///< of the pixels in each bin
  int pixels = 0, saturated = 0;
};

/// Where the pixels near an instrument's axis are, without the lens' distortion: along and across the axis. Made once;
/// its size is that of the band around the axis, whatever the size of the sensor.
class AxisMap {
 public:
  /// @param begin, end  of the band along the axis [px]
  /// @param half_width  of the band [px]
  AxisMap(const CameraModel& camera, const SlideAxis& axis, double begin, double end, double half_width);

  /// Of a place at the axis as seen through the lens; NaN where the lens cannot show it.
  Eigen::Vector2d pixel(double along, double lateral) const;

  /// The pixels within half extents of a place, a quarter and then the second quarter of a checkered pattern first, so
  /// that the beginning of the block samples all of the window. Those outside of the
  /// frame and those near saturated ones get weight 0. No allocation once the block is large enough; pixels that the
  /// block has no room for are left out. @return the pixels of the full sensor around them
  cv::Rect gather(const Frame& frame, const Eigen::Vector2d& centre, const Eigen::Vector2d& half_extents,
                  PixelBlock& pixels);

  /// Sums the frame over a part of the band around the axis; bins outside of it are empty. No allocation.
  void readBand(const Frame& frame, double begin, double end, double half_width, AxisProfile& profile) const;

 private:
  struct Row {
    int begin = 0, end = 0;  ///< columns of the sensor
    std::size_t first = 0;   ///< place in along_ and lateral_
  };
  std::vector<Eigen::Vector2d> border(double begin, double end, double half_width) const;
  void addRow(int y, const std::vector<Eigen::Vector2d>& border);
  cv::Rect boundsOf(const Eigen::Vector2d& centre, const Eigen::Vector2d& half_extents) const;
  void markSaturated(const Frame& frame, const cv::Rect& rect);
  void markHalo(const cv::Rect& rect, int x, int y);
  void gatherRow(const Frame& frame, const cv::Rect& rect, int y, int parity, const Eigen::Vector2d& centre,
                 const Eigen::Vector2d& half_extents, PixelBlock& pixels) const;

  CameraModel camera_;
  SlideAxis axis_;
  Eigen::Vector2d across_;
  int first_row_ = 0;
  std::vector<Row> rows_;
  std::vector<float> along_, lateral_;
  std::vector<std::uint8_t> saturated_;  ///< by pixels of the rectangle, if any_saturated_
  bool any_saturated_ = false;
};

}  // namespace vibe::vision
