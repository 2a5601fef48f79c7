#pragma once
#include <glob.h>

#include <memory>
#include <opencv2/imgcodecs.hpp>
#include <string>
#include <vector>

#include "vibe_core/files/files.hpp"
#include "vibe_core/program/error.hpp"
#include "vibe_vision/image/frame.hpp"

namespace vibe::vision {

/// Files of a pattern such as 'folder/*.png' in the order of their names. @throws Error if there are none
inline std::vector<std::string> filesOf(const std::string& pattern) {
  glob_t found{};
  const int status = glob(pattern.c_str(), 0, nullptr, &found);
  std::vector<std::string> files(found.gl_pathv, found.gl_pathv + found.gl_pathc);
  globfree(&found);
  if (status != 0 || files.empty()) {
    throw Error(pattern + ": matches no file; give a pattern in quotes, for example 'images/*.png'");
  }
  return files;
}

/// An image as grey values. @throws Error if it cannot be read
inline Frame readGrey(const std::string& file) {
  const auto image = std::make_shared<cv::Mat>(cv::imread(file, cv::IMREAD_GRAYSCALE));
  if (image->empty()) throw Error(file + ": cannot be read as an image; give PNG, PGM, TIFF, BMP or JPEG");
  Frame frame;
  frame.image = {image->data, image->cols, image->rows, static_cast<int>(image->step)};
  frame.sensor_width = image->cols;
  frame.sensor_height = image->rows;
  frame.owner = image;
  return frame;
}

/// Whole or not at all. @param parameters  of the format, as OpenCV takes them. @throws Error if it cannot be written
inline void writePicture(const std::string& file, const cv::Mat& picture, const std::string& what = "The picture",
                         const std::vector<int>& parameters = {}) {
  writeWhole(
      file, [&](const std::string& part) { return cv::imwrite(part, picture, parameters); }, what);
}

}  // namespace vibe::vision
