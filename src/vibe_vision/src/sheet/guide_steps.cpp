#include "sheet/guide_steps.hpp"

#include "calibrate/fitting.hpp"
#include "vibe_core/files/number_text.hpp"

namespace vibe::vision {
namespace {

/// "rig.yaml" -> "rig_2.yaml": what the second command writes.
std::string numbered(const std::string& file, std::size_t number) {
  const std::string end = ".yaml";
  const bool ends = file.size() > end.size() && file.compare(file.size() - end.size(), end.size(), end) == 0;
  return (ends ? file.substr(0, file.size() - end.size()) : file) + "_" + std::to_string(number) + end;
}

GuideStep axisStep(const std::string& rig, const std::vector<std::string>& instruments) {
  const std::string& first = instruments.front();
  std::string what =
      "Put " + first +
      " at 8 to 12 known slides over its whole range, with gauge blocks, and take a picture at each with "
      "the camera's own viewer. List them in stops.csv.";
  if (instruments.size() > 1)
    what += " Then the same for " + listOf(std::vector<std::string>(instruments.begin() + 1, instruments.end())) +
            ", each beginning with the file that was written last.";
  return {
      "Axis of each instrument.", what,
      "rosrun vibe_vision vibe_calibrate axis --config " + numbered(rig, 1) + " --instrument " + first + " --stops " +
          first + "/stops.csv --output " + numbered(rig, 2),
      "\"residual ...\": along, the error of your gauges (0.1 mm for a ruler); across, below 0.5 px. All stops are "
      "used.",
      "\"left out\" with a residual: a slip in the list. \"nothing in the image looks like the marker\": light, focus, "
      "or the marker of another instrument. \"points to negative slide\": glue the sleeve the other way round."};
}

}  // namespace

std::vector<GuideStep> guideSteps(const SheetOptions& options, const std::vector<std::string>& instruments) {
  const std::string& rig = options.config_file;
  const std::string last = numbered(rig, instruments.size() + 1);
  const BoardSpec& board = options.board_spec;
  const std::string squares = formatted(" --board %dx%d --square %gmm", board.columns, board.rows, 1e3 * board.square);
  return {
      {"Print and glue.",
       "Print all pages at 100 % on matt paper. A sleeve goes around its rod, its arrow to positive slide; a flat "
       "marker faces the camera; the chessboard goes on a flat plate.",
       "rosrun vibe_vision vibe_marker_sheet --config " + rig + " --pdf markers.pdf",
       "Both rulers of each page measure 100.0 mm.",
       "Print without \"fit to page\". If they still differ, correct the sizes in " + rig + "."},
      {"Camera.",
       "It looks across the axes and sees the whole range of every instrument. Set focus, aperture and an exposure of "
       "1 ms. From now on touch neither lens nor camera.",
       "rosrun vibe_vision vibe_camera_check gige:",
       "\"lost 0, incomplete 0, unreadable 0\" and the rate of the camera.",
       "No frame: cable, power, address; arv-tool-0.8 lists cameras. A webcam is v4l2:/dev/video0, here and below."},
      {"Pictures of the chessboard.",
       "Hold the plate where the instruments are, all of it in view: at all sides of the image, and tilted by 20 to "
       "40 degrees to all four sides. Hold it still until \"Taken\", then do what is said.",
       "rosrun vibe_vision vibe_calibrate boards --config " + rig + " --source gige: --folder lens" + squares,
       "\"Nothing is missing\"",
       "\"Not taken\": it says why: light, blur, a part out of view. \"Still missing\" after a minute: again, with "
       "another --folder and --seconds 180."},
      {"Lens.", "Measure the squares over the whole board, and write their true side into the command.",
       "rosrun vibe_vision vibe_calibrate intrinsics --config " + rig + " --images 'lens/*.png'" + squares +
           " --output " + numbered(rig, 1),
       "\"residual\" over all corners below 0.5 px (0.1 is usual), and no \"Warning\".",
       "Do what the warning says. Mostly: the plate is not flat, a picture is blurred (remove it), or too few are "
       "tilted (take more)."},
      axisStep(rig, instruments),
      {"Check.",
       "Move each instrument slowly through its whole range, several times, then fast for some seconds; turn what "
       "turns. One minute. Again after each transport and before each series.",
       "rosrun vibe_vision vibe_calibrate check --config " + last + " --source gige:", "\"The calibration holds.\"",
       "\"WRONG\": its line says what to do. \"not shown\": move further, faster, or turn, and check again."},
      {"Use it.", "The node publishes the joints of all instruments; with roscore running:",
       "rosrun vibe_vision vision_node _config:=$PWD/" + last + " _source:=gige:",
       "rostopic echo suturing_device/input/joint_states follows your hand.",
       "rostopic echo /diagnostics says which instrument is lost, and why."}};
}

}  // namespace vibe::vision
