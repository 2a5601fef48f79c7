#pragma once
#include <vector>

#include "camera/picture_reader.hpp"

namespace vibe::vision {

/// Numbers in names count by their value: frame_9 is before frame_10.
bool isBefore(const std::string& a, const std::string& b);

class ImageListReader : public PictureReader {
 public:
  /// @throws Error if no file matches
  explicit ImageListReader(const std::string& pattern);
  Result next(cv::Mat& picture) override;
  void rewind() override { index_ = 0; }
  std::size_t count() const override { return files_.size(); }
  bool isCountExact() const override { return true; }
  std::string complaint() const override { return complaint_; }
  std::string folder() const;  ///< of the first image

 private:
  std::vector<std::string> files_;
  std::size_t index_ = 0;
  std::string complaint_;
};

}  // namespace vibe::vision
