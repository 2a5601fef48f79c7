#pragma once
#include <opencv2/videoio.hpp>

#include "camera/picture_reader.hpp"

namespace vibe::vision {

class VideoReader : public PictureReader {
 public:
  /// @throws Error if the file is not there or is no video
  explicit VideoReader(const std::string& file);
  Result next(cv::Mat& picture) override;
  void rewind() override;
  std::size_t count() const override { return count_; }
  bool isCountExact() const override { return false; }
  std::string complaint() const override { return complaint_; }

 private:
  std::string file_, complaint_;
  cv::VideoCapture capture_;
  std::size_t count_ = 0, read_ = 0;

  void open();
};

}  // namespace vibe::vision
