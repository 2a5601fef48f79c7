#include <filesystem>
#include <iomanip>
#include <optional>

#include "image_files.hpp"
#include "program_options.hpp"
#include "vibe_core/files/files.hpp"
#include "vibe_core/files/number_text.hpp"
#include "vibe_core/program/error.hpp"
#include "vibe_vision/synthetic/renderer.hpp"
#include "video_file.hpp"

namespace vision = vibe::vision;

namespace {

struct Options {
  std::string scene = "moving", out, format = "images";
  std::uint64_t first = 0, frames = 147;
  double start = 0;
};

/// Where the pixels go.
class Recording {
 public:
  Recording(const Options& options, const vision::SyntheticScene& scene) : folder_(options.out) {
    const cv::Size size(scene.camera.width, scene.camera.height);
    if (options.format == "video") video_.emplace(folder_ / "video.mkv", "FFV1", scene.rate, size, false);
  }

  void add(const vision::Frame& frame) {
    if (video_) return video_->add(frame.image.mat());
    const std::string name = vibe::formatted("frame_%06llu.png", static_cast<unsigned long long>(frame.sequence));
    vision::writePicture(folder_ / name, frame.image.mat(), "The picture", {cv::IMWRITE_PNG_COMPRESSION, 1});
  }

  void finish() {
    if (video_) video_->finish();
  }

 private:
  std::filesystem::path folder_;
  std::optional<vision::VideoFile> video_;
};

void render(const Options& options) {
  const vision::SyntheticScene scene = vision::namedScene(options.scene);
  std::error_code failed;
  std::filesystem::create_directories(options.out, failed);
  if (failed) throw vibe::Error(options.out + ": the folder cannot be made: " + failed.message() + ".");
  const std::filesystem::path folder(options.out);
  std::ostringstream stamps, truth;
  stamps << std::setprecision(17), truth << std::setprecision(17);
  vibe::writeFile(folder / "config.yaml", vision::toYaml(vision::nominalConfig(scene)), "The configuration");
  stamps << "sequence,stamp,exposure\n";
  truth << vision::kTruthColumns;

  const vision::Renderer renderer(scene);
  Recording recording(options, scene);
  for (std::uint64_t k = options.first; k < options.first + options.frames; ++k) {
    const vision::RenderedFrame rendered = renderer.render(k, options.start);
    recording.add(rendered.frame);
    stamps << rendered.frame.sequence << ',' << rendered.frame.stamp << ',' << rendered.frame.exposure << '\n';
    for (std::size_t i = 0; i < rendered.truth.size(); ++i)
      vision::writeTruth(truth, rendered.frame.sequence, rendered.frame.stamp, scene.instruments[i].nominal.name,
                         rendered.truth[i]);
  }
  recording.finish();
  vibe::writeFile(folder / (options.format == "video" ? "video.mkv.csv" : "frames.csv"), stamps.str(), "The table");
  vibe::writeFile(folder / "truth.csv", truth.str(), "The truth");
}

}  // namespace

int main(int argc, char** argv) {
  vibe::CommandLine line(
      "Draws what the camera of a synthetic scene sees, with the truth: images frame_NNNNNN.png and frames.csv, or\n"
      "video.mkv (lossless) and video.mkv.csv, with sequence, stamp [s] and exposure [s] of each frame; truth.csv\n"
      "with slide [m], rotation [rad] and places [px] of each instrument; config.yaml for vibe_track.",
      "vibe_render");
  Options options;
  std::string names;
  for (const std::string& name : vision::sceneNames()) names += (names.empty() ? "" : ", ") + name;
  line.option("--scene", options.scene, "one of " + names).showDefault();
  line.option("--frames", options.frames, "number of frames; 147 are one second")
      .check(vibe::inRange(1, 10000000))
      .showDefault();
  line.option("--first", options.first, "number of the first frame").showDefault();
  line.option("--start", options.start, "stamp of frame 0, Unix time [s]").check(vibe::finiteIn(0, 1e10)).showDefault();
  line.option("--out", options.out, "folder, made if it is not there").required();
  line.option("--format", options.format, "images or video").check(vibe::oneOf({"images", "video"})).showDefault();
  return vibe::runProgram(line, argc, argv, [&options] {
    render(options);
    return 0;
  });
}
