#pragma once

#include <cstdint>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "camera/frame_table.hpp"
#include "camera/picture_reader.hpp"
#include "camera/pixels.hpp"
#include "vibe_vision/camera/frame_source.hpp"

namespace vibe::vision {

/// A recording as a source. Stamps are those of its table. Without one, frame k is at k / rate; if the recording is
/// paced, this counts from the time at which it was first read, as if a camera took it now.
class RecordingSource : public FrameSource {
 public:
  /// @throws Error if the table does not fit the recording
  RecordingSource(const std::string& name, std::unique_ptr<PictureReader> reader, std::optional<FrameTable> table,
                  const SourceOptions& options);
  ReadResult read(Frame& frame, double timeout) override;
  SourceStatistics statistics() const override;
  std::string status() const override;

 private:
  std::string name_;
  std::unique_ptr<PictureReader> reader_;
  std::optional<FrameTable> table_;
  SourceOptions options_;
  PixelPool pool_;
  std::size_t index_ = 0;                     // of the next picture
  int width_ = 0, height_ = 0;                // of the first picture
  double started_ = 0;                        // host time of the first read
  double stamp_shift_ = 0;                    // of repetitions
  std::uint64_t sequence_shift_ = 0;          // of repetitions
  std::uint64_t last_ = 0, thrown_away_ = 0;  // sequence of the last frame, and how many were of no use since
  bool has_last_ = false;
  Frame pending_;  // read, but not due yet
  bool has_pending_ = false;

  mutable std::mutex mutex_;  // of what follows
  SourceStatistics statistics_;
  std::string complaint_;

  ReadResult prepare();
  bool repeat();
  FrameTable::Row rowOf(std::size_t index) const;
  bool accept(const cv::Mat& picture);
  void fill(const cv::Mat& picture, const FrameTable::Row& row);
  void reportFault(const std::string& text, std::uint64_t unreadable);
};

}  // namespace vibe::vision
