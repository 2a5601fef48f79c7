#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <ostream>
#include <string>
#include <vector>

#include "vibe_vision/config/vision_config.hpp"

namespace vibe::vision {

/// Motion of one instrument in a synthetic scene.
struct SyntheticMotion {
  std::function<double(double)> slide;     ///< time [s] -> [m]
  std::function<double(double)> rotation;  ///< time [s] -> [rad]
};

/// A square tag of another library, to be compared with: its cells row by row, border included, 1: white.
struct SyntheticTag {
  int cells = 0;                    ///< per side; 0: no tag
  std::vector<std::uint8_t> white;  ///< cells x cells; 1: white, 0: black
  double side = 4e-3;               ///< of the cells together; one cell of white is around them [m]
};

/// An instrument as it truly is, in the camera frame (x right, y down, z forward) [m]. The marker's centre slides along
/// the one straight line in space whose picture is nominal.axis; the centre of a sleeve is on the axis of its rod. A
/// flat marker is parallel to the sensor if the line is. Tilt and slant turn a marker about its centre, on top of that:
/// they leave slide and axis as they are. The rotation of a sleeve is counted from the direction to the camera.
struct SyntheticInstrument {
  InstrumentConfig nominal;  ///< as calibrated; marker and axis
  SyntheticTag tag;          ///< drawn instead of nominal.marker if it has cells; needed if that is a tag: setTag()
  SyntheticMotion motion;    ///< of the marker along and about the axis
  double tilt = 0;           ///< of the marker about the view direction, from the axis to its right (y down) [rad]
  double slant = 0;          ///< of the marker out of the image plane; positive: its positive end is further away [rad]
  double scale = 1;          ///< of the marker: it is printed larger by this factor
  double lateral = 0;        ///< offset of the marker across the axis, to the right of the direction [m]
};

/// Gives an instrument a tag, and its picture.
void setTag(SyntheticInstrument& instrument, const TagDesign& tag);

/// What spoils a picture. The default spoils nothing but noise and focus blur.
struct Degradation {
  double exposure = 1e-3;  ///< [s]
  double blur = 0.6;       ///< standard deviation of the point spread function [px]
  PixelNoise noise;        ///< of the sensor, that the picture has
  double flicker = 0;      ///< relative amplitude at 100 Hz
  double drift = 0;        ///< relative change of the light per second, down and up again in 2 s [1/s]
  double vignetting = 0;   ///< share of the light lost in the corners
  std::array<double, 5>
      distortion{};         ///< the config's camera has the same: a calibrated lens; coefficients k1, k2, p1, p2, k3
  int highlights = 0;       ///< saturated spots on each marker; they are fixed in space, it moves through
  bool occluder = false;    ///< a bar, 6 mm wide, that sweeps across the axes
  bool look_alike = false;  ///< the same marker, 0.75 times as large, that passes beside
};

struct SyntheticScene {
  CameraModel camera;                               ///< with Degradation::distortion
  double rate = 147;                                ///< [Hz]
  std::vector<SyntheticInstrument> instruments;     ///< in the order of the truths of a frame
  Degradation degradation;                          ///< of the picture
  double white = 170, black = 25, background = 90;  ///< [DN] at full light; the background is textured
  std::uint64_t seed = 1;                           ///< of noise and texture; the same gives the same bits
};

/// Where an instrument truly is in one frame, at the middle of the exposure.
struct SyntheticTruth {
  double slide = 0, rotation = 0;  ///< [m], [rad]
  double along = 0, lateral = 0;   ///< of the marker's centre relative to the nominal axis, undistorted [px]
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();  ///< distorted [px]
  double velocity = 0;                              ///< along [px/s]
  /// Share of the marker that is neither covered nor out of view. Counted is the disc of a ring, the lit half of a
  /// sleeve as it is seen, the cells of a tag.
  double visible = 1;
};

/// First line of a table of truths.
constexpr const char* kTruthColumns = "sequence,stamp,instrument,slide,rotation,along,lateral,x,y,velocity,visible\n";
/// A line of it.
void writeTruth(std::ostream& table, std::uint64_t sequence, double stamp, const std::string& instrument,
                const SyntheticTruth& truth);

/// The rig as a calibration would describe it.
VisionConfig nominalConfig(const SyntheticScene& scene);
/// At time [s]; the middle of the exposure of frame k is at k / rate.
SyntheticTruth truthAt(const SyntheticScene& scene, std::size_t instrument, double time);

/// Two instruments, helix sleeve and needle-driver ring, at 0.1 mm/px in 728 x 544; they move with a peak of 0.5 m/s.
SyntheticScene standardScene();
constexpr double kBlinkSlide = 1e-3;  ///< of the helix before the jump of blinkScene() [m]
/// The instruments at rest; from the second frame on, the helix has slid by `jump` [m].
SyntheticScene blinkScene(double jump);

constexpr double kSwayMiddle = 0.010;     ///< of the helix in swayScene() [m]
constexpr double kSwayAmplitude = 0.008;  ///< [m]
constexpr double kSwayRate = 1.5;  ///< [Hz]; the peak speed of 75 mm/s is one that the simulated helix can follow
constexpr int kSwayFrames = 50;    ///< at 147 Hz half a period, from turn to turn
/// For measuring the age of positions: the helix goes to and fro as a sine. Shown forward and backward, its frames from
/// 0 to kSwayFrames are the whole motion.
SyntheticScene swayScene();
/// The degradations of the benchmark by name: "static", "moving" (1 ms), "long_exposure" (4 ms), "defocus", "light",
/// "highlights", "occluder", "look_alike", "all", "tilt", "scale". @throws Error for another name, with those there are
SyntheticScene namedScene(const std::string& name);
std::vector<std::string> sceneNames();  ///< that namedScene() knows

}  // namespace vibe::vision
