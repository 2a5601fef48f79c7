#pragma once

#include <cstdint>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "camera/picture_reader.hpp"
#include "camera/pixels.hpp"
#include "vibe_vision/camera/frame_source.hpp"

namespace vibe::vision {

/// What a recording knows about its frames, from a text file with one row per frame and commas between columns. The
/// first line names the columns: "stamp" (middle of the exposure, Unix time [s]) is needed, "sequence" and "exposure"
/// [s] may be there, others are ignored.
struct FrameTable {
  struct Row {
    std::uint64_t sequence = 0;
    double stamp = 0;
    double exposure = 0;
  };
  std::vector<Row> rows;
  std::string file;

  /// @param exposure  of all frames if the file does not say
  /// @throws Error with file, line and remedy: no such column, not a number, stamps or sequence that do not increase
  static FrameTable load(const std::string& file, double exposure);
};

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
