// vibe_track: tracks recorded images or a video. No ROS.

#include <unistd.h>

#include <cstdio>
#include <ctime>
#include <filesystem>
#include <memory>
#include <optional>

#include "image_files.hpp"
#include "program_options.hpp"
#include "vibe_core/clocks/step_timer.hpp"
#include "vibe_core/files/number_text.hpp"
#include "vibe_core/program/error.hpp"
#include "vibe_vision/camera/frame_source.hpp"
#include "vibe_vision/record/annotation.hpp"
#include "vibe_vision/record/track_table.hpp"
#include "vibe_vision/track/tracker.hpp"
#include "video_file.hpp"

namespace vision = vibe::vision;

namespace {

constexpr double kTimeout = 5;         // [s]; a recording answers at once
constexpr double kProgressPeriod = 1;  // [s]

struct Options {
  std::string video, images, config, csv, annotate;
  vision::SourceOptions source;
  std::uint64_t frames = 0;
};

void addOptions(vibe::OptionList& line, Options& options) {
  vibe::OptionList input = line.oneRequired("recording");
  input.option("--video", options.video, "Video file; stamps from FILE.csv if it is there");
  input.option("--images", options.images,
               "Images in the order of their names, 'folder/*.png' in quotes; stamps "
               "from frames.csv in the folder if it is there");
  line.option("--config", options.config, "YAML file or package:// address of the rig").required();
  line.option("--csv", options.csv, "Write the results to this file").required();
  line.option("--annotate", options.annotate,
              "Draw the results: into FILE.avi or FILE.mkv, or as images into a folder");
  line.option("--frames", options.frames, "End after so many frames (default: all)")
      .check(vibe::inRange(1, 1000000000));
  line.option("--rate", options.source.rate, "Of a recording without stamps [Hz]").showDefault();
  line.option("--exposure", options.source.exposure, "Of a recording that does not tell it [s]").showDefault();
  line.option("--roi-x", options.source.roi_x, "Where the recording was cut from the sensor [px]");
  line.option("--roi-y", options.source.roi_y, "The same, rows [px]");
}

/// Draws the results into a video or a folder.
class Annotator {
 public:
  Annotator(std::string target, double rate) : target_(std::move(target)), rate_(rate) {
    const std::string end = std::filesystem::path(target_).extension();
    is_video_ = end == ".avi" || end == ".mkv";
    std::error_code failed;
    if (!is_video_ && !end.empty() && !std::filesystem::is_directory(target_, failed)) fail();  // another kind of video
    if (!is_video_ && !target_.empty()) std::filesystem::create_directories(target_, failed);
    if (failed) fail();
  }

  void add(const vision::VisionConfig& config, const vision::Frame& frame, const vision::Measurements& measurements) {
    if (target_.empty()) return;
    const cv::Mat picture = vision::annotate(config, frame, measurements);
    if (is_video_) return addToVideo(picture);
    vision::writePicture(target_ + vibe::formatted("/frame_%06llu.png", static_cast<unsigned long long>(count_++)),
                         picture);
  }

  void finish() {
    if (video_) video_->finish();
  }

 private:
  std::string target_;
  double rate_;
  bool is_video_ = false;
  unsigned long long count_ = 0;
  std::optional<vision::VideoFile> video_;

  [[noreturn]] void fail() const {
    throw vibe::Error(target_ + ": cannot be written; give a folder, or a file that ends in .avi or .mkv");
  }
  void addToVideo(const cv::Mat& picture) {
    if (!video_) video_.emplace(target_, "MJPG", rate_, picture.size(), true);
    video_->add(picture);
  }
};

/// A recording that was cut from the sensor does not tell how large that was.
void completeSize(const vision::VisionConfig& config, const Options& options, vision::Frame& frame) {
  if (options.source.roi_x == 0 && options.source.roi_y == 0) return;
  if (frame.sensor_width <= config.camera.width) frame.sensor_width = config.camera.width;
  if (frame.sensor_height <= config.camera.height) frame.sensor_height = config.camera.height;
}

/// One line that is overwritten, on a terminal only.
class Progress {
 public:
  void show(std::uint64_t frames) {
    if (!isatty(STDERR_FILENO)) return;
    const std::time_t now = std::time(nullptr);
    if (static_cast<double>(now - last_) < kProgressPeriod) return;
    last_ = now;
    std::fprintf(stderr, "\r%llu frames", static_cast<unsigned long long>(frames));
  }
  ~Progress() {
    if (last_ != 0) std::fprintf(stderr, "\r                              \r");
  }

 private:
  std::time_t last_ = 0;
};

/// Results must not overwrite what they are made from.
void requireOtherFile(const Options& options) {
  const std::filesystem::path images(options.images);
  const std::filesystem::path table =
      options.video.empty() ? images.parent_path() / "frames.csv" : std::filesystem::path(options.video + ".csv");
  for (const std::filesystem::path& input : {std::filesystem::path(options.config), table}) {
    std::error_code missing;
    if (!std::filesystem::equivalent(options.csv, input, missing)) continue;
    throw vibe::Error("--csv: " + options.csv + " belongs to the recording; give another file");
  }
}

int run(Options options) {
  requireOtherFile(options);
  const vision::VisionConfig config = vision::VisionConfig::load(options.config);
  vision::Tracker tracker(config);
  options.source.roi_width = options.source.roi_height = 0;
  const std::unique_ptr<vision::FrameSource> source =
      vision::openSource(options.video.empty() ? "images:" + options.images : "video:" + options.video, options.source);
  vision::TrackTable table(options.csv, config);
  vision::TrackSummary summary(config);
  Annotator annotator(options.annotate, options.source.rate);
  {
    Progress progress;
    vision::Frame frame;
    vision::ReadResult result = vision::ReadResult::Frame;
    while ((result = source->read(frame, kTimeout)) == vision::ReadResult::Frame) {
      completeSize(config, options, frame);
      if (summary.frames() == 0)
        vision::requireSize(config.camera, frame.sensor_width, frame.sensor_height, "the recording has",
                            "use the configuration of the camera that took it, or give --roi-x and --roi-y");
      const double begin = vibe::threadCpuTime();
      const vision::Measurements& measurements = tracker.track(frame);
      summary.add(measurements, vibe::threadCpuTime() - begin);
      table.add(frame, measurements);
      annotator.add(config, frame, measurements);
      progress.show(summary.frames());
      if (summary.frames() == options.frames) break;
    }
    if (result != vision::ReadResult::End && result != vision::ReadResult::Frame) throw vibe::Error(source->status());
  }
  table.close();
  annotator.finish();
  if (summary.frames() == 0) throw vibe::Error(source->status() + "; it has no frame, give another recording");
  std::printf("%s%llu frames, %llu missing in the recording; results in %s\n", summary.text().c_str(),
              static_cast<unsigned long long>(summary.frames()),
              static_cast<unsigned long long>(source->statistics().lost), options.csv.c_str());
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  vibe::CommandLine line("Tracks the instruments in a video or in images and writes their slides and rotations.",
                         "vibe_track");
  Options options;
  addOptions(line, options);
  return vibe::runProgram(line, argc, argv, [&options] { return run(options); });
}
