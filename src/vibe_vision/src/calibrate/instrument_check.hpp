#pragma once
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "vibe_vision/calibrate/calibration_check.hpp"
#include "vibe_vision/track/tracker.hpp"

namespace vibe::vision {

/// Numbers along a path that runs from -1 to 1: their mean, the change from its middle to its end by a straight line,
/// and that by a bow, with standard deviations.
struct Course;

/// What a check knows of one instrument.
class InstrumentCheck {
 public:
  InstrumentCheck(const InstrumentConfig& config, const CameraModel& camera);

  /// @param m  of the tracker that follows all frames
  void follow(const Measurement& m, double stamp);
  /// Whether a picture at this place tells something new.
  bool isNew(const Measurement& m) const;
  /// @param alone  of a tracker that knows this picture only. @param slide  of the tracker that follows [m]
  void look(const Measurement& alone, double slide);
  CheckedInstrument result() const;
  /// By how much the focal length would explain what was seen [1], and its standard deviation; infinite if this motion
  /// does not show it.
  std::pair<double, double> focalError() const;

 private:
  /// One picture, measured by itself, relative to the axis.
  struct Look {
    double along = 0, lateral = 0, log_scale = 0;  ///< [px], [px], 1
  };
  /// What was seen of the axis, along it [px].
  struct Path {
    double middle = 0, half = 0;
  };
  using Places = std::vector<std::pair<double, double>>;  ///< place, value
  static constexpr double kInfinity = std::numeric_limits<double>::infinity();

  InstrumentConfig config_;
  CameraModel camera_;
  int height_;       // of the image, rows
  double lens_ = 0;  // where the axis is nearest to the lens' centre, along it [px]
  std::uint64_t frames_ = 0, tracked_ = 0, fast_ = 0;
  std::map<Doubt, std::uint64_t> doubts_;                   // frames with each
  double fastest_ = 0;                                      // without a doubt [m/s]
  double from_ = kInfinity, to_ = -kInfinity;               // slides [m]
  double least_turn_ = kInfinity, most_turn_ = -kInfinity;  // [rad]
  double last_slide_ = 0, last_stamp_ = 0, last_look_ = 0;
  std::vector<Look> looks_;

  struct Courses;
  std::optional<Courses> courses() const;
  void predictFocal(const Path& seen, Places& sizes, Places& paths) const;
  Path binned(double Look::*quantity, Places& bins) const;
  void addGeometry(std::vector<CheckedQuantity>& quantities) const;
  void addSizes(const Course& size, std::vector<CheckedQuantity>& quantities) const;
  void addPath(const Course& path, double half, std::vector<CheckedQuantity>& quantities) const;
  std::uint64_t framesWith(Doubt doubt) const;
  double share(Doubt doubt) const;
  std::string hidden(Doubt doubt) const;
  std::string whyUnknown(Doubt doubt) const;
  CheckedQuantity judgeDoubt(Doubt doubt, const std::string& wrong) const;
};

}  // namespace vibe::vision
