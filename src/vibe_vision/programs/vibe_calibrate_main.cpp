// vibe_calibrate: lens and axes of a rig from images, or the lens from files of other programs. No ROS.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>

#include "check_calibration.hpp"
#include "image_files.hpp"
#include "program_options.hpp"
#include "take_boards.hpp"
#include "vibe_core/files/files.hpp"
#include "vibe_core/program/error.hpp"
#include "vibe_vision/calibrate/axis_fit.hpp"
#include "vibe_vision/calibrate/board_guide.hpp"
#include "vibe_vision/calibrate/lens_calibration.hpp"
#include "vibe_vision/calibrate/marker_finder.hpp"
#include "vibe_vision/calibrate/stop_list.hpp"
#include "vibe_vision/camera/capture.hpp"
#include "vibe_vision/config/camera_files.hpp"

namespace vision = vibe::vision;

namespace {

constexpr double kDegree = M_PI / 180;
constexpr std::size_t kMostImages = 60;  // of a free motion; more are left out evenly

struct Options {
  std::string config, output, images, stops, instrument, camera_file, camera_name, ros_file, kalibr_file, address,
      folder;
  std::string board = "9x6", square = "5 mm";
  double lowest_scale = 4, highest_scale = 25;        // [px/mm]
  double print_tolerance = 0.5, slant_tolerance = 5;  // [%], [deg]
  double seconds = 60;
  vision::SourceOptions source;
};

void addCommon(vibe::OptionList& line, Options& options) {
  line.option("--config", options.config, "YAML file of the rig; everything but the result is kept").required();
  line.option("--output", options.output, "Write the rig with the result to this YAML file").required();
}

void addBoardOptions(vibe::OptionList& line, Options& options) {
  line.option("--board", options.board, "Inner corners of the chessboard").showDefault();
  line.option("--square", options.square, "Measured side of a square").showDefault();
}

void addFileOptions(vibe::OptionList& import_lens, vibe::OptionList& export_lens, Options& options) {
  addCommon(import_lens, options);
  import_lens.option("--camera", options.camera_file, "camera_info of ROS or camchain of Kalibr, YAML").required();
  import_lens.option("--name", options.camera_name, "Camera of a camchain with several ones, for example cam0");
  export_lens.option("--config", options.config, "YAML file of the rig").required();
  vibe::OptionList format = export_lens.oneRequired("format");
  format.option("--ros", options.ros_file, "Write a camera_info file of ROS, plumb_bob");
  format.option("--kalibr", options.kalibr_file, "Write a camchain of Kalibr, pinhole-radtan");
}

void addOptions(vibe::OptionList& lens, vibe::OptionList& axis, Options& options) {
  addCommon(lens, options);
  lens.option("--images", options.images, "Images of the chessboard, 'folder/*.png' in quotes").required();
  addBoardOptions(lens, options);
  addCommon(axis, options);
  axis.option("--instrument", options.instrument, "Name of the instrument").required();
  vibe::OptionList input = axis.oneRequired("motion");
  input.option("--stops", options.stops, "CSV file: image,slide; the instrument stands at known slides");
  input.option("--images", options.images,
               "Images of a free motion in order, 'folder/*.png' in quotes; slide 0 is in the first");
  axis.option("--lowest-scale", options.lowest_scale, "Smallest scale to look for [px/mm]")
      .showDefault()
      .check(vibe::inRange(0.5, 1000.0));
  axis.option("--highest-scale", options.highest_scale, "Largest scale to look for [px/mm]")
      .showDefault()
      .check(vibe::inRange(0.5, 1000.0));
  axis.option("--print-tolerance", options.print_tolerance,
              "Free motion: standard deviation of the printed marker's size [%]")
      .showDefault()
      .check(vibe::inRange(0.0, 20.0));
  axis.option("--slant-tolerance", options.slant_tolerance,
              "Free motion: by how much the axis may be slanted against the sensor [deg]")
      .showDefault()
      .check(vibe::inRange(0.0, 45.0));
}

/// Of what looks at a camera or a recording for some time.
void addSourceOptions(vibe::OptionList& line, Options& options) {
  line.option("--config", options.config, "YAML file of the rig").required();
  line.option("--source", options.address, "gige:ADDRESS, v4l2:/dev/video0, video:FILE or images:'DIR/*.png'")
      .required();
  line.option("--seconds", options.seconds, "Time to look [s]").check(vibe::finiteIn(0.1, 1e5)).showDefault();
  line.option("--rate", options.source.rate, "Asked of a camera; of a recording without stamps [Hz]").showDefault();
  line.option("--exposure", options.source.exposure, "Asked of a camera; of a recording that does not tell it [s]")
      .showDefault();
}

void printWarnings(const std::vector<std::string>& warnings) {
  for (const std::string& warning : warnings) std::printf("Warning: %s.\n", warning.c_str());
}

/// What could not be read again is not written.
void save(const vision::VisionConfig& config, const std::string& file) {
  const std::string yaml = vision::toYaml(config);
  vision::VisionConfig::parse(yaml, "the result", vision::AxisRule::Optional);
  vibe::writeFile(file, yaml, "The configuration");
  std::printf("Written to %s.\n", file.c_str());
}

/// The rig with another lens.
void saveLens(vision::VisionConfig config, const vision::CameraModel& camera, const std::string& file) {
  config.camera = camera;
  bool had_axes = false;
  for (vision::InstrumentConfig& instrument : config.instruments) {
    had_axes = had_axes || instrument.axis.isCalibrated();
    instrument.axis = {};
  }
  if (had_axes) std::printf("The axes belong to the old camera and are left out; run vibe_calibrate axis.\n");
  save(config, file);
}

void requireOneSize(const std::string& name, const vision::Frame& frame, const vision::Frame& first) {
  if (frame.image.width == first.image.width && frame.image.height == first.image.height) return;
  throw vibe::Error(name + ": has " + vision::sizeText(frame.image.width, frame.image.height) +
                    " px, the first image has " + vision::sizeText(first.image.width, first.image.height) +
                    " px; take all with the same camera and region");
}

/// Says of each picture what it is good for, and at the end what is missing.
std::vector<vision::BoardView> findBoards(const std::vector<std::string>& files, const vision::BoardSpec& board,
                                          double focal_length, vision::Frame& first) {
  std::vector<vision::BoardView> views;
  std::optional<vision::BoardGuide> guide;
  for (const std::string& file : files) {
    const vision::Frame frame = vision::readGrey(file);
    if (first.image.empty()) first = frame;
    requireOneSize(file, frame, first);
    if (!guide) guide.emplace(board, focal_length, first.image.width, first.image.height);
    const vision::BoardPicture picture = guide->look(frame.image);
    if (!picture.corners) {
      std::printf("%s: left out, %s\n", file.c_str(), picture.problem.c_str());
      continue;
    }
    if (!picture.problem.empty()) std::printf("%s: used, but %s\n", file.c_str(), picture.problem.c_str());
    if (!guide->isNew(*picture.corners)) std::printf("%s: shows the board as an earlier one does\n", file.c_str());
    guide->take(*picture.corners);
    views.push_back({file, *picture.corners});
  }
  if (guide && !guide->missing().empty()) std::printf("Still missing: %s.\n", guide->missing().c_str());
  return views;
}

void printLens(const vision::LensCalibration& lens) {
  for (const vision::BoardFit& view : lens.views) {
    std::printf("%s: residual %.3f px, tilt %.0f deg\n", view.name.c_str(), view.rms, view.tilt / kDegree);
  }
  const vision::CameraModel& c = lens.camera;
  std::printf("focal length %.2f +- %.2f, %.2f +- %.2f px\n", c.fx, lens.deviation[0], c.fy, lens.deviation[1]);
  std::printf("centre %.2f +- %.2f, %.2f +- %.2f px\n", c.cx, lens.deviation[2], c.cy, lens.deviation[3]);
  const char* const kNames[] = {"k1", "k2", "p1", "p2", "k3"};
  std::printf("distortion");
  for (std::size_t i = 0; i < 5; ++i) {
    if (lens.estimated[i]) std::printf(" %s %.5g", kNames[i], c.distortion[i]);
  }
  std::printf("; other coefficients are not significant and 0\n");
  std::printf("residual %.3f px over all corners; the corners cover %.0f %% of the image\n", c.reprojection_rms,
              100 * lens.coverage);
}

/// A focal length that is a guess would spoil all axes that are calibrated with it.
void requireFocalLength(const vision::LensCalibration& lens) {
  constexpr double kUseless = 0.05;
  const double uncertain = lens.deviation[0] / lens.camera.fx;
  if (uncertain <= kUseless) return;
  throw vibe::Error("these images leave the focal length uncertain by " +
                    std::to_string(std::lround(100 * std::min(uncertain, 10.0))) +
                    " %, so nothing is written; tilt the board by 20 to 40 deg, to all sides");
}

int calibrateLens(const Options& options) {
  const vision::VisionConfig config = vision::VisionConfig::load(options.config, vision::AxisRule::Optional);
  const vision::BoardSpec board = vision::boardOption(options.board, options.square);
  vision::Frame first;
  const std::vector<vision::BoardView> views =
      findBoards(vision::filesOf(options.images), board, config.camera.fx, first);
  const vision::LensCalibration lens = vision::calibrateLens(views, board, first.image.width, first.image.height);
  printLens(lens);
  printWarnings(lens.warnings);
  requireFocalLength(lens);
  saveLens(config, lens.camera, options.output);
  return 0;
}

int importLens(const Options& options) {
  const vision::VisionConfig config = vision::VisionConfig::load(options.config, vision::AxisRule::Optional);
  saveLens(config, vision::loadCameraFile(options.camera_file, options.camera_name), options.output);
  return 0;
}

int exportLens(const Options& options) {
  const vision::VisionConfig config = vision::VisionConfig::load(options.config, vision::AxisRule::Optional);
  const bool ros = options.kalibr_file.empty();
  const std::string& file = ros ? options.ros_file : options.kalibr_file;
  const auto format = ros ? vision::CameraFileFormat::Ros : vision::CameraFileFormat::Kalibr;
  vibe::writeFile(file, vision::toCameraFile(config.camera, format), "The camera");
  std::printf("Written to %s.\n", file.c_str());
  return 0;
}

void printAxis(const vision::SlideAxis& axis) {
  const auto deviation = [&axis](int i) { return std::sqrt(axis.covariance(i, i)); };
  std::printf("origin %.3f, %.3f px; +- %.3f along, %.3f across\n", axis.origin.x(), axis.origin.y(), deviation(0),
              deviation(1));
  std::printf("direction %.4f +- %.4f deg (0: to the right, 90: down)\n",
              std::atan2(axis.direction.y(), axis.direction.x()) / kDegree, deviation(2) / kDegree);
  std::printf("scale %.4f +- %.4f px/mm", 1e-3 * axis.pixels_per_metre, 1e-3 * deviation(3));
  if (axis.perspective != 0) std::printf("; perspective %.4f +- %.4f 1/m", axis.perspective, deviation(4));
  std::printf("\n");
}

vision::MarkerSearch searchOf(const Options& options) {
  return {1e3 * options.lowest_scale, 1e3 * options.highest_scale};
}

/// A sleeve that is glued the other way round would be tracked nowhere.
void requireSleeveForwards(const vision::LocatedMarkers& located, const vision::SlideAxis& axis) {
  if (located.direction.dot(axis.direction) >= 0) return;
  throw vibe::Error(
      "the sleeve points to negative slide; glue it the other way round, or give the slides with the other sign and "
      "write 'sign: -1' at slide_joint");
}

void printInk(double ink) {
  if (ink == 0) return;
  std::printf("The print is bolder than designed by %.1f um at each edge; written as 'ink'.\n", 1e6 * ink);
}

void sayWhatTakesTime(std::size_t images) {
  std::printf("Looks for the marker in %zu images; this takes seconds for each.\n", images);
  std::fflush(stdout);
}

/// Beyond the outermost stops an axis is a guess.
void warnAboutRange(const vision::InstrumentConfig& instrument, const std::vector<vision::AxisStop>& stops) {
  constexpr double kFar = 0.15;  // of the range
  const auto [low, high] =
      std::minmax_element(stops.begin(), stops.end(), [](const auto& a, const auto& b) { return a.slide < b.slide; });
  const double far = kFar * (instrument.upper - instrument.lower);
  const bool below = low->slide - instrument.lower > far, above = instrument.upper - high->slide > far;
  if (!below && !above) return;
  std::printf(
      "Warning: the stops are between %.1f and %.1f mm, the range is from %.1f to %.1f mm; add stops near its %s.\n",
      1e3 * low->slide, 1e3 * high->slide, 1e3 * instrument.lower, 1e3 * instrument.upper,
      below && above ? "ends"
      : below        ? "lower end"
                     : "upper end");
}

vision::SlideAxis axisFromStops(const Options& options, const vision::VisionConfig& config, std::size_t instrument,
                                double& ink) {
  const std::vector<vision::StopImage> list = vision::loadStopList(options.stops);
  std::vector<vision::Frame> images;
  for (const vision::StopImage& stop : list) images.push_back(vision::readGrey(stop.image));
  sayWhatTakesTime(images.size());
  const vision::LocatedMarkers located = vision::locateMarkers(config, instrument, images, searchOf(options));
  ink = located.ink;
  std::vector<vision::AxisStop> stops;
  for (std::size_t i = 0; i < list.size(); ++i) {
    if (located.markers[i].found) {
      stops.push_back({list[i].image, list[i].slide, located.markers[i].pixel});
    } else {
      std::printf("%s: left out, %s\n", list[i].image.c_str(), located.markers[i].problem.c_str());
    }
  }
  const vision::AxisFit fit = vision::fitAxis(stops);
  for (std::size_t i = 0; i < stops.size(); ++i) {
    std::printf("%s: slide %.3f mm, residual %.3f px along (%.4f mm), %.3f px across%s\n", stops[i].name.c_str(),
                1e3 * stops[i].slide, fit.stops[i].along,
                1e3 * fit.stops[i].along / vision::pixelsPerMetre(fit.axis, stops[i].slide), fit.stops[i].across,
                fit.stops[i].left_out ? ", left out" : "");
  }
  printAxis(fit.axis);
  std::printf("residual %.3f px along (%.4f mm), %.3f px across\n", fit.rms_along, 1e3 * fit.axis.residual_rms,
              fit.rms_across);
  printWarnings(fit.warnings);
  warnAboutRange(config.instruments[instrument], stops);
  requireSleeveForwards(located, fit.axis);
  return fit.axis;
}

std::vector<std::string> thinnedOut(const std::vector<std::string>& files) {
  if (files.size() <= kMostImages) return files;
  std::vector<std::string> some;
  for (std::size_t i = 0; i < kMostImages; ++i) some.push_back(files[i * (files.size() - 1) / (kMostImages - 1)]);
  return some;
}

vision::SlideAxis axisFromMotion(const Options& options, const vision::VisionConfig& config, std::size_t instrument,
                                 double& ink) {
  std::vector<vision::Frame> images;
  for (const std::string& file : thinnedOut(vision::filesOf(options.images))) images.push_back(vision::readGrey(file));
  sayWhatTakesTime(images.size());
  const vision::LocatedMarkers located = vision::locateMarkers(config, instrument, images, searchOf(options));
  if (!located.markers.front().found) {
    throw vibe::Error("the marker was not found in the first image, where slide 0 is (" +
                      located.markers.front().problem + "); begin with an image that shows it");
  }
  ink = located.ink;
  std::vector<vision::MotionSample> samples;
  for (const vision::LocatedMarker& marker : located.markers)
    if (marker.found) samples.push_back({marker.pixel, marker.pixels_per_metre});
  const vision::ScaleTrust trust{options.print_tolerance / 100, options.slant_tolerance * kDegree};
  const vision::MotionFit fit = vision::fitMotion(samples, trust, located.direction);
  std::printf("marker found in %zu of %zu images\n", samples.size(), images.size());
  printAxis(fit.axis);
  std::printf("residual %.3f px across; scale from the size of the print, uncertain by %.2f %%\n", fit.rms_across,
              100 * fit.scale_uncertainty);
  std::printf("The perspective is not observable without known slides and is set to 0.\n");
  printWarnings(fit.warnings);
  return fit.axis;
}

int calibrateAxis(const Options& options) {
  vision::VisionConfig config = vision::VisionConfig::load(options.config, vision::AxisRule::Optional);
  const std::size_t instrument = config.indexOf(options.instrument);
  if (options.highest_scale < options.lowest_scale)
    throw vibe::Error("--highest-scale is below --lowest-scale; exchange them");
  double ink = 0;
  const vision::SlideAxis axis = options.stops.empty() ? axisFromMotion(options, config, instrument, ink)
                                                       : axisFromStops(options, config, instrument, ink);
  printInk(ink);
  config.instruments[instrument].axis = axis;
  config.instruments[instrument].ink = ink;
  save(config, options.output);
  return 0;
}

/// A camera may be faster than a board is found: then the newest frame counts.
int takeBoards(const Options& options) {
  constexpr double kWait = 1;  // [s]
  const vision::VisionConfig config = vision::VisionConfig::load(options.config, vision::AxisRule::Optional);
  vision::BoardTaker taker(vision::boardOption(options.board, options.square), config.camera.fx, options.folder);
  auto source = vision::openSource(options.address, options.source);
  std::optional<vision::Capture> capture;
  if (!vision::isRecording(options.address)) capture.emplace(std::move(source));
  const auto next = [&](vision::Frame& frame) {
    return capture ? capture->take(frame, kWait) : source->read(frame, kWait);
  };
  const auto say = [](const std::string& sentence) {
    std::printf("%s\n", sentence.c_str());
    std::fflush(stdout);
  };
  const bool complete = vision::takeBoards(next, options.seconds, taker, say);
  say(complete ? "Nothing is missing: vibe_calibrate intrinsics --images '" + options.folder + "/*.png'"
               : "Still missing: " + taker.missing() + ".");
  return complete ? vision::kHolds : vision::kNotShown;
}

int checkCalibration(const Options& options) {
  const vision::VisionConfig config = vision::VisionConfig::load(options.config);
  vision::CalibrationCheck check(config);
  const auto source = vision::openSource(options.address, options.source);
  std::printf("Move each instrument slowly through its whole range several times, then fast; turn what turns.\n");
  std::fflush(stdout);
  vision::watchMotion(*source, config, options.seconds, check);
  return vision::printCheck(config, check.result());
}

}  // namespace

int main(int argc, char** argv) {
  vibe::CommandLine line(
      "Calibrates a rig: 'intrinsics' the lens from a chessboard, 'axis' where an instrument slides; 'boards' takes\n"
      "its images, 'check' tells "
      "whether a calibration still holds; 'import' and 'export' exchange the lens with ROS and Kalibr.",
      "vibe_calibrate");
  Options options;
  vibe::OptionList lens =
      line.subcommand("intrinsics", "Lens from images of a chessboard (vibe_marker_sheet prints it)");
  vibe::OptionList boards = line.subcommand(
      "boards", "Takes the images of a chessboard that is held before a camera, and says which are missing");
  vibe::OptionList axis =
      line.subcommand("axis", "Axis, direction and scale of an instrument from images of its motion");
  vibe::OptionList check = line.subcommand(
      "check",
      "Whether a calibration holds, from a free motion; status 0: it does, 1: it does not, 3: not all was shown");
  vibe::OptionList import_lens = line.subcommand("import", "Lens from the calibration of another program");
  vibe::OptionList export_lens = line.subcommand("export", "Lens as a file for other programs");
  line.requireSubcommand();
  addOptions(lens, axis, options);
  addSourceOptions(check, options);
  addSourceOptions(boards, options);
  addBoardOptions(boards, options);
  boards.option("--folder", options.folder, "Where the pictures go").required();
  addFileOptions(import_lens, export_lens, options);
  return vibe::runProgram(line, argc, argv, [&] {
    if (lens.isChosen()) return calibrateLens(options);
    if (boards.isChosen()) return takeBoards(options);
    if (check.isChosen()) return checkCalibration(options);
    if (import_lens.isChosen()) return importLens(options);
    return export_lens.isChosen() ? exportLens(options) : calibrateAxis(options);
  });
}
