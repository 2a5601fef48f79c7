#pragma once
#include <cstdint>
#include <memory>
#include <opencv2/core.hpp>

namespace vibe::vision {

/// 8-bit grey pixels that somebody else owns, row by row. Pixel (0, 0) is the upper left one of the view; coordinates
/// are those of pixel centres, as in OpenCV and ROS: the view covers [-0.5, width - 0.5) x [-0.5, height - 0.5).
struct ImageView {
  const std::uint8_t* data = nullptr;  ///< of the upper left pixel
  int width = 0, height = 0;           ///< [px]
  int stride = 0;                      ///< bytes from one row to the next, >= width

  /// The left pixel of row y, 0 to height - 1.
  const std::uint8_t* row(int y) const { return data + static_cast<std::ptrdiff_t>(y) * stride; }
  bool empty() const { return width <= 0 || height <= 0; }
  /// The same for functions of OpenCV, which must only read it.
  cv::Mat mat() const {
    return {height, width, CV_8U, const_cast<std::uint8_t*>(data), static_cast<std::size_t>(stride)};
  }
};

/// One exposure of a global-shutter camera. Copies share the pixels.
struct Frame {
  ImageView image;                          ///< what was exposed, the region of interest only
  std::shared_ptr<const void> owner;        ///< keeps image.data alive; empty: the caller does
  int offset_x = 0, offset_y = 0;           ///< of the view in the full image of the sensor [px]
  int sensor_width = 0, sensor_height = 0;  ///< full image, that of the camera model [px]

  std::uint64_t sequence = 0;  ///< counted by the camera: gaps are lost frames
  double stamp = 0;            ///< middle of the exposure, host clock (Unix time) [s]
  double exposure = 0;         ///< [s]; 0: unknown
  double arrival = 0;          ///< of the last byte at the host [s]; for latency only, never a stamp
};

}  // namespace vibe::vision
