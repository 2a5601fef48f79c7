#include "camera/recording_source.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <opencv2/imgproc.hpp>

#include "camera/host_time.hpp"
#include "vibe_core/program/error.hpp"

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

}  // namespace

RecordingSource::RecordingSource(const std::string& name, std::unique_ptr<PictureReader> reader,
                                 std::optional<FrameTable> table, const SourceOptions& options)
    : name_(name), reader_(std::move(reader)), table_(std::move(table)), options_(options) {
  if (table_) checkCount(name_, *table_, *reader_);
}

ReadResult RecordingSource::read(Frame& frame, double timeout) {
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
  const std::lock_guard<std::mutex> lock(mutex_);
  ++statistics_.frames;
  return ReadResult::Frame;
}

/// Reads one picture. @return Frame if the recording goes on, even if this picture was of no use
ReadResult RecordingSource::prepare() {
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

bool RecordingSource::repeat() {
  if (statistics().frames == 0) return false;
  const double duration = rowOf(index_ - 1).stamp - rowOf(0).stamp;
  const double period = index_ > 1 ? duration / static_cast<double>(index_ - 1) : 1 / options_.rate;
  stamp_shift_ += duration + period;
  sequence_shift_ = last_ + 1 - rowOf(0).sequence;
  index_ = 0;
  reader_->rewind();
  return true;
}

FrameTable::Row RecordingSource::rowOf(std::size_t index) const {
  if (table_) return table_->rows[std::min(index, table_->rows.size() - 1)];
  const double start = options_.paced ? started_ : 0;
  return {index, start + static_cast<double>(index) / options_.rate, options_.exposure};
}

bool RecordingSource::accept(const cv::Mat& picture) {
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
  reportFault(name_ + ": frame " + std::to_string(index_ - 1) + " has " + std::to_string(picture.cols) + " x " +
                  std::to_string(picture.rows) + " pixels, but the first has " + std::to_string(width_) + " x " +
                  std::to_string(height_) + "; it is left out",
              1);
  return false;
}

void RecordingSource::fill(const cv::Mat& picture, const FrameTable::Row& row) {
  const std::shared_ptr<std::uint8_t> pixels =
      pool_.acquire(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_));
  toGrey(picture).copyTo(cv::Mat(height_, width_, CV_8U, pixels.get()));
  Frame& frame = pending_;
  frame.image = {pixels.get(), width_, height_, width_};
  frame.owner = pixels;
  frame.offset_x = options_.roi_x;
  frame.offset_y = options_.roi_y;
  frame.sensor_width = options_.roi_x + width_;
  frame.sensor_height = options_.roi_y + height_;
  frame.sequence = row.sequence + sequence_shift_;
  frame.stamp = row.stamp + stamp_shift_;
  frame.exposure = row.exposure;
  const std::lock_guard<std::mutex> lock(mutex_);
  if (has_last_ && frame.sequence > last_ + 1 + thrown_away_) {
    statistics_.lost += frame.sequence - last_ - 1 - thrown_away_;
  }
  thrown_away_ = 0;
  has_last_ = true;
  last_ = frame.sequence;
  has_pending_ = true;
}

void RecordingSource::reportFault(const std::string& text, std::uint64_t unreadable) {
  const std::lock_guard<std::mutex> lock(mutex_);
  complaint_ = text;
  statistics_.unreadable += unreadable;
  thrown_away_ += unreadable;
}

SourceStatistics RecordingSource::statistics() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return statistics_;
}

std::string RecordingSource::status() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return complaint_.empty() ? name_ : complaint_;
}

namespace {

constexpr double kMaxSequence = 9e15;  // integers that a double holds

std::vector<std::string> cells(const std::string& line) {
  std::vector<std::string> all(1);
  for (const char c : line) {
    if (c == ',') all.emplace_back();
    if (c != ',' && c != ' ' && c != '\t' && c != '\r' && c != '#') all.back() += c;
  }
  return all;
}

class Reader {
 public:
  Reader(const std::string& file, double exposure) : file_(file), exposure_(exposure), stream_(file) {
    if (!stream_) throw Error(file + ": cannot be read; check that it exists and its permissions.");
  }

  FrameTable read() {
    FrameTable table;
    table.file = file_;
    header();
    std::string line;
    while (std::getline(stream_, line)) {
      ++line_;
      if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
      table.rows.push_back(row(cells(line), table.rows.size()));
      if (table.rows.size() > 1) checkOrder(table.rows[table.rows.size() - 2], table.rows.back());
    }
    return table;
  }

 private:
  std::string file_;
  double exposure_;
  std::ifstream stream_;
  int line_ = 1;
  int stamp_ = -1, sequence_ = -1, exposure_column_ = -1;
  std::size_t columns_ = 0;

  std::string place() const { return file_ + ":" + std::to_string(line_) + ": "; }

  void header() {
    std::string line;
    std::getline(stream_, line);
    const std::vector<std::string> names = cells(line);
    columns_ = names.size();
    for (int i = 0; i < static_cast<int>(names.size()); ++i) {
      if (names[i] == "stamp") stamp_ = i;
      if (names[i] == "sequence") sequence_ = i;
      if (names[i] == "exposure") exposure_column_ = i;
    }
    if (stamp_ < 0) {
      throw Error(place() + "no column is called stamp; the first line must name the columns, such as " +
                  "\"sequence,stamp,exposure\".");
    }
  }

  FrameTable::Row row(const std::vector<std::string>& values, std::size_t index) const {
    if (values.size() != columns_) {
      throw Error(place() + std::to_string(values.size()) + " values, but the first line names " +
                  std::to_string(columns_) + " columns; complete or remove this line.");
    }
    FrameTable::Row row;
    row.stamp = number(values[stamp_], "stamp");
    row.exposure = exposure_column_ < 0 ? exposure_ : number(values[exposure_column_], "exposure");
    row.sequence = sequence_ < 0 ? index : sequence(values[sequence_]);
    return row;
  }

  double number(const std::string& text, const char* name) const {
    char* end = nullptr;
    const double value = std::strtod(text.c_str(), &end);
    if (!text.empty() && *end == '\0' && std::isfinite(value) && value >= 0) return value;
    throw Error(place() + name + " is \"" + text + "\"; it must be a number of seconds, 0 or more.");
  }

  std::uint64_t sequence(const std::string& text) const {
    const double value = number(text, "sequence");
    if (value == std::floor(value) && value < kMaxSequence) return static_cast<std::uint64_t>(value);
    throw Error(place() + "sequence is \"" + text + "\"; it must be a whole number.");
  }

  void checkOrder(const FrameTable::Row& before, const FrameTable::Row& after) const {
    if (after.stamp <= before.stamp) throw Error(place() + "stamp does not increase; sort the lines by time.");
    if (after.sequence <= before.sequence) throw Error(place() + "sequence does not increase; sort the lines by time.");
  }
};

}  // namespace

FrameTable FrameTable::load(const std::string& file, double exposure) {
  return Reader(file, exposure).read();
}

}  // namespace vibe::vision
