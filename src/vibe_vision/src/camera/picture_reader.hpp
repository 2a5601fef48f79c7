#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <opencv2/core.hpp>
#include <opencv2/videoio.hpp>

namespace vibe::vision {

/// Pictures of a recording one after the other.
class PictureReader {
 public:
  enum class Result { Picture, Unreadable, End };

  virtual ~PictureReader() = default;
  /// @param picture  8 or 16 bits, 1 or 3 channels (BGR); shares no memory with the next one
  virtual Result next(cv::Mat& picture) = 0;
  virtual void rewind() = 0;
  virtual std::size_t count() const = 0;  ///< of all pictures; 0 if unknown
  virtual bool isCountExact() const = 0;  ///< containers of video know it only roughly
  /// What the last call of next() found wrong; empty if nothing.
  virtual std::string complaint() const = 0;
};

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
