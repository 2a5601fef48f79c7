#pragma once
#include <cstddef>
#include <opencv2/core.hpp>
#include <string>

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

}  // namespace vibe::vision
