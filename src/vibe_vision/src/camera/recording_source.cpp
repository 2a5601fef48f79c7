#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>

#include <opencv2/imgproc.hpp>

#include "camera/frame_table.hpp"
#include "camera/host_time.hpp"
#include "camera/picture_reader.hpp"
#include "camera/sources.hpp"
#include "vibe_core/program/error.hpp"
#include "vibe_vision/image/camera_model.hpp"

namespace vibe::vision {

namespace {

constexpr double kCountTolerance = 0.02;  // of the number of frames that a container of video tells

void checkCount(const std::string& name, const FrameTable& table, const PictureReader& reader) {
  const auto rows = static_cast<double>(table.rows.size()), frames = static_cast<double>(reader.count());
  const double tolerance = reader.isCountExact() ? 0 : 1 + kCountTolerance * frames;
  if (rows > 0 && (frames == 0 || std::abs(rows - frames) <= tolerance)) return;
  throw Error(table.file + ": has " + std::to_string(table.rows.size()) + " rows, but " + name + " has " +
              std::to_string(reader.count()) + " frames; it needs one row per frame, or remove it.");
}

cv::Mat toGrey(const cv::Mat& picture) {
  cv::Mat bytes = picture, grey;
  if (picture.depth() == CV_16U) picture.convertTo(bytes, CV_8U, 1.0 / 256, -0.498);  // the upper 8 bits
  if (bytes.channels() == 1) return bytes;
  cv::cvtColor(bytes, grey, bytes.channels() == 4 ? cv::COLOR_BGRA2GRAY : cv::COLOR_BGR2GRAY);
  return grey;
}

class RecordingSource : public ReportingSource {
 public:
  /// @param table  a file that may be there
  RecordingSource(const std::string& name, std::unique_ptr<PictureReader> reader, const std::string& table,
                  const SourceOptions& options)
      : ReportingSource(name), name_(name), reader_(std::move(reader)), options_(options) {
    if (std::filesystem::exists(table)) table_ = FrameTable::load(table, options.exposure);
    if (table_) checkCount(name_, *table_, *reader_);
  }

  ReadResult read(Frame& frame, double timeout) override {
    if (started_ == 0) started_ = hostTime();
    const double deadline = steadyTime() + timeout;
    while (!has_pending_) {
      const ReadResult result = prepare();
      if (result != ReadResult::Frame) return result;
    }
    if (options_.paced) {
      const double first = table_ ? table_->rows.front().stamp : started_;
      const double due = started_ + (pending_.stamp - first) + pending_.exposure / 2;
      sleepFor(std::min(due - hostTime(), deadline - steadyTime()));
      if (hostTime() < due) return ReadResult::Timeout;
    }
    frame = pending_;
    frame.arrival = hostTime();
    pending_ = Frame();
    has_pending_ = false;
    count(&SourceStatistics::frames);
    return ReadResult::Frame;
  }

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

  /// Reads one picture. @return Frame if the recording goes on, even if this picture was of no use
  ReadResult prepare() {
    cv::Mat picture;
    const PictureReader::Result result = reader_->next(picture);
    if (result == PictureReader::Result::Unreadable) {
      reportFault(reader_->complaint(), 1);
      ++index_;
      return ReadResult::Frame;
    }
    if (result == PictureReader::Result::End) {
      if (!reader_->complaint().empty()) reportFault(name_ + " " + reader_->complaint(), 0);
      return options_.loop && index_ > 0 && repeat() ? ReadResult::Frame : ReadResult::End;
    }
    if (table_ && index_ >= table_->rows.size()) {
      reportFault(table_->file + ": has fewer rows than " + name_ + " has frames; it needs one row per frame", 1);
      return ReadResult::End;
    }
    const FrameTable::Row row = rowOf(index_++);
    if (accept(picture)) fill(picture, row);
    return ReadResult::Frame;
  }

  bool repeat() {
    if (statistics().frames == 0) return false;
    const double duration = rowOf(index_ - 1).stamp - rowOf(0).stamp;
    const double period = index_ > 1 ? duration / static_cast<double>(index_ - 1) : 1 / options_.rate;
    stamp_shift_ += duration + period;
    sequence_shift_ = last_ + 1 - rowOf(0).sequence;
    index_ = 0;
    reader_->rewind();
    return true;
  }

  FrameTable::Row rowOf(std::size_t index) const {
    if (table_) return table_->rows[std::min(index, table_->rows.size() - 1)];
    const double start = options_.paced ? started_ : 0;
    return {index, start + static_cast<double>(index) / options_.rate, options_.exposure};
  }

  bool accept(const cv::Mat& picture) {
    const bool has_depth = picture.depth() == CV_8U || picture.depth() == CV_16U;
    if (!has_depth || (picture.channels() != 1 && picture.channels() != 3 && picture.channels() != 4)) {
      reportFault(name_ + ": frame " + std::to_string(index_ - 1) + " is neither grey nor colour of 8 or 16 bits", 1);
      return false;
    }
    if (width_ == 0) {
      width_ = picture.cols;
      height_ = picture.rows;
    }
    if (picture.cols == width_ && picture.rows == height_) return true;
    reportFault(name_ + ": frame " + std::to_string(index_ - 1) + " has " + sizeText(picture.cols, picture.rows) +
                    " pixels, but the first has " + sizeText(width_, height_) + "; it is left out",
                1);
    return false;
  }

  void fill(const cv::Mat& picture, const FrameTable::Row& row) {
    Frame& frame = pending_;
    toGrey(picture).copyTo(cv::Mat(height_, width_, CV_8U, pool_.give(frame, width_, height_)));
    frame.offset_x = options_.roi_x;
    frame.offset_y = options_.roi_y;
    frame.sensor_width = options_.roi_x + width_;
    frame.sensor_height = options_.roi_y + height_;
    frame.sequence = row.sequence + sequence_shift_;
    frame.stamp = row.stamp + stamp_shift_;
    frame.exposure = row.exposure;
    if (has_last_ && frame.sequence > last_ + 1 + thrown_away_)
      count(&SourceStatistics::lost, frame.sequence - last_ - 1 - thrown_away_);
    thrown_away_ = 0;
    has_last_ = true;
    last_ = frame.sequence;
    has_pending_ = true;
  }

  void reportFault(const std::string& text, std::uint64_t unreadable) {
    say(text);
    count(&SourceStatistics::unreadable, unreadable);
    thrown_away_ += unreadable;
  }
};

}  // namespace

std::unique_ptr<FrameSource> openVideo(const std::string& file, const SourceOptions& options) {
  return std::make_unique<RecordingSource>("video:" + file, std::make_unique<VideoReader>(file), file + ".csv",
                                           options);
}

std::unique_ptr<FrameSource> openImages(const std::string& pattern, const SourceOptions& options) {
  auto reader = std::make_unique<ImageListReader>(pattern);
  const std::string table = reader->folder() + "/frames.csv";
  return std::make_unique<RecordingSource>("images:" + pattern, std::move(reader), table, options);
}

}  // namespace vibe::vision
