#include "calibrate/instrument_check.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "calibrate/fitting.hpp"
#include "vibe_vision/record/track_table.hpp"

namespace vibe::vision {

struct Course {
  Eigen::Vector3d value = Eigen::Vector3d::Zero(), deviation = Eigen::Vector3d::Zero();
};

namespace {

constexpr double kDegree = M_PI / 180;

// Design choices: what a calibration may be off before somebody should care.
constexpr double kScaleLimit = 0.01;  // prints are right to 0.5 %
constexpr double kDirectionLimit = 0.3 * kDegree;
constexpr double kAcrossLimit = 0.5;         // of the lateral tolerance
constexpr double kPerspectiveLimit = 0.005;  // change of size from one end to the other
constexpr double kLensLimit = 0.003;         // change of size from the middle to the ends
constexpr double kPathLimit = 5e-5;          // bow of the path [m]
constexpr double kSure = 3;                  // standard deviations

constexpr double kFocalTrial = 0.02;  // of the focal length, for what it would do

constexpr int kBins = 25;                // along the range
constexpr std::size_t kFewestBins = 10;  // for a straight line and a bow
constexpr double kLeastPath = 0.5;       // of the range that has to be seen
constexpr double kWholeMarker = 0.6;     // share of it that has to be seen; shade alone takes some of a sleeve
constexpr double kDoubtful = 0.1;        // share of frames that makes a doubt a fault
constexpr double kHides = 0.5;           // share of frames with one doubt from which others are not seen
constexpr std::uint64_t kEnough = 30;    // frames that are fast enough
constexpr double kFast = 0.05;           // from which the tracker looks for distortions [m/s]
constexpr double kOneMotion = 0.1;       // between frames that show a speed [s]
constexpr double kTurn = M_PI / 2;       // that shows an askew sleeve
constexpr double kUnchecked = 2.5e-4;    // by which the shutter may move a marker that is not `unchecked` [m]

/// @param bins  values by place. @param centre  place of the lens' centre, from which a wrong lens bends everything
Course courseOf(const std::vector<std::pair<double, double>>& bins, double centre) {
  Eigen::MatrixXd a(static_cast<Eigen::Index>(bins.size()), 3);
  Eigen::VectorXd b(a.rows());
  const auto bow = [centre](double u) { return u * u - 1.0 / 3 - 2 * centre * u; };
  for (Eigen::Index row = 0; row < a.rows(); ++row) {
    const auto& [u, value] = bins[static_cast<std::size_t>(row)];
    a.row(row) << 1, u, bow(u);
    b(row) = value;
  }
  const LinearFit fit = solveLinear(a, b);
  return {fit.solution, fit.covariance.diagonal().cwiseSqrt()};
}

std::string signedNumber(double value, int decimals) {
  return (value < 0 ? "" : "+") + withDecimals(value, decimals);
}

/// @param factor  from SI to the unit
CheckedQuantity judge(const std::string& name, double value, double deviation, double limit, double factor,
                      const std::string& unit, int decimals, const std::string& remedy) {
  CheckedQuantity q{name, Verdict::Unknown, value, deviation, limit, ""};
  const bool sure = kSure * deviation <= limit;
  if (std::abs(value) > limit && std::abs(value) > kSure * deviation)
    q.verdict = Verdict::Wrong;
  else if (sure && std::abs(value) <= limit)
    q.verdict = Verdict::Holds;
  q.text = signedNumber(factor * value, decimals) + " +- " + withDecimals(factor * deviation, decimals) + " " + unit +
           ", limit " + withDecimals(factor * limit, decimals);
  if (q.verdict == Verdict::Wrong) q.text += "; " + remedy;
  if (q.verdict == Verdict::Unknown) q.text += "; move it to and fro more often, slowly";
  return q;
}

}  // namespace

InstrumentCheck::InstrumentCheck(const InstrumentConfig& config, const CameraModel& camera)
    : config_(config), camera_(camera), height_(camera.height) {
  lens_ = (Eigen::Vector2d(camera.cx, camera.cy) - config.axis.origin).dot(config.axis.direction);
}

void InstrumentCheck::follow(const Measurement& m, double stamp) {
  ++frames_;
  if (!m.tracked()) return;
  const double dt = stamp - last_stamp_;
  const double speed = tracked_ > 0 && dt > 0 && dt < kOneMotion ? std::abs(m.slide - last_slide_) / dt : 0;
  ++tracked_;
  ++doubts_[m.doubt];
  if (speed > kFast) ++fast_;
  if (m.doubt == Doubt::None) fastest_ = std::max(fastest_, speed);
  from_ = std::min(from_, m.slide), to_ = std::max(to_, m.slide);
  if (std::isfinite(m.rotation))
    least_turn_ = std::min(least_turn_, m.rotation), most_turn_ = std::max(most_turn_, m.rotation);
  last_slide_ = m.slide, last_stamp_ = stamp;
}

bool InstrumentCheck::isNew(const Measurement& m) const {
  const double step = (config_.upper - config_.lower) / (4 * kBins);
  return m.tracked() && (looks_.empty() || std::abs(m.slide - last_look_) > step);
}

void InstrumentCheck::look(const Measurement& alone, double slide) {
  last_look_ = slide;
  if (alone.tracked() && alone.visible >= kWholeMarker)
    looks_.push_back({alone.along, alone.lateral, std::log(alone.scale)});
}

CheckedInstrument InstrumentCheck::result() const {
  CheckedInstrument result{config_.name, frames_, tracked_, tracked_ > 0 ? from_ : 0, tracked_ > 0 ? to_ : 0, {}};
  addGeometry(result.quantities);
  std::string wrong;
  for (const CheckedQuantity& q : result.quantities)
    if (wrong.empty() && q.verdict == Verdict::Wrong) wrong = q.name;
  const bool turns = std::holds_alternative<SleeveDesign>(config_.marker);
  const bool tag = std::holds_alternative<TagDesign>(config_.marker);  // whose cells do not show how it is bent and lit
  for (const Doubt doubt : {Doubt::Shutter, Doubt::Askew, Doubt::Bent, Doubt::Response})
    if (doubt == Doubt::Shutter || (doubt == Doubt::Askew ? turns : !tag))
      result.quantities.push_back(judgeDoubt(doubt, wrong));
  return result;
}

/// Medians of one quantity by place, from -1 to 1 over what was seen.
InstrumentCheck::Path InstrumentCheck::binned(double Look::*quantity, Places& bins) const {
  double low = kInfinity, high = -low;
  for (const Look& look : looks_) low = std::min(low, look.along), high = std::max(high, look.along);
  const double length = std::max(high - low, 1.0);  // all at one place: in one bin
  std::array<std::vector<double>, kBins> places, values;
  for (const Look& look : looks_) {
    const double share = (look.along - low) / length;
    const auto bin = static_cast<std::size_t>(std::clamp(share * kBins, 0.0, kBins - 1.0));
    places[bin].push_back(2 * share - 1);
    values[bin].push_back(look.*quantity);
  }
  for (std::size_t i = 0; i < kBins; ++i)
    if (!values[i].empty()) bins.emplace_back(median(places[i]), median(values[i]));
  return {(low + high) / 2, (high - low) / 2};
}

struct InstrumentCheck::Courses {
  Course size, path;
  Path seen;
  double centre = 0;  ///< of the lens, from -1 to 1 over what was seen
};

/// If enough of the range was seen.
std::optional<InstrumentCheck::Courses> InstrumentCheck::courses() const {
  Places sizes, paths;
  Path seen;
  if (!looks_.empty()) seen = binned(&Look::log_scale, sizes), binned(&Look::lateral, paths);
  const double range = std::abs(alongOf(config_.axis, config_.upper) - alongOf(config_.axis, config_.lower));
  if (sizes.size() < kFewestBins || 2 * seen.half < kLeastPath * range) return std::nullopt;
  const double centre = (lens_ - seen.middle) / seen.half;
  return Courses{courseOf(sizes, centre), courseOf(paths, centre), seen, centre};
}

/// What kFocalTrial more of the focal length would do to sizes and path: the lens would be taken to bend everything
/// less.
void InstrumentCheck::predictFocal(const Path& seen, Places& sizes, Places& paths) const {
  CameraModel other = camera_;
  other.fx *= 1 + kFocalTrial, other.fy *= 1 + kFocalTrial;
  const Eigen::Vector2d across = acrossOf(config_.axis);
  const auto seenAs = [&](double along) {
    return Eigen::Vector2d(undistort(other, distort(camera_, pixelAt(config_.axis, along))) - config_.axis.origin);
  };
  for (int i = 0; i < kBins; ++i) {
    const double place = 2.0 * i / (kBins - 1) - 1, along = seen.middle + place * seen.half;
    sizes.emplace_back(place, std::log(0.5 * (seenAs(along + 1) - seenAs(along - 1)).norm()));
    paths.emplace_back(place, seenAs(along).dot(across));
  }
}

std::pair<double, double> InstrumentCheck::focalError() const {
  const std::optional<Courses> seen = courses();
  if (!seen) return {0, kInfinity};
  Places sizes, paths;
  predictFocal(seen->seen, sizes, paths);
  const double size = courseOf(sizes, seen->centre).value[2], path = courseOf(paths, seen->centre).value[2];
  const auto weight = [](double effect, const Course& course) { return effect / std::pow(course.deviation[2], 2); };
  const double by_size = weight(size, seen->size), by_path = weight(path, seen->path);
  const double information = by_size * size + by_path * path;
  if (!(information > 0)) return {0, kInfinity};
  return {kFocalTrial * (by_size * seen->size.value[2] + by_path * seen->path.value[2]) / information,
          kFocalTrial / std::sqrt(information)};
}

void InstrumentCheck::addGeometry(std::vector<CheckedQuantity>& quantities) const {
  const std::optional<Courses> all = courses();
  if (!all) {
    Places places;
    const Path seen = looks_.empty() ? Path() : binned(&Look::log_scale, places);
    const double range = std::abs(alongOf(config_.axis, config_.upper) - alongOf(config_.axis, config_.lower));
    for (const char* name : {"scale", "direction", "across", "perspective", "lens", "path"})
      quantities.push_back({name, Verdict::Unknown, 0, 0, 0,
                            "seen along " + withDecimals(200 * seen.half / range, 0) + " % of the range, in " +
                                std::to_string(looks_.size()) + " pictures; move it slowly through the whole range"});
    return;
  }
  addSizes(all->size, quantities);
  addPath(all->path, all->seen.half, quantities);
}

void InstrumentCheck::addSizes(const Course& size, std::vector<CheckedQuantity>& quantities) const {
  quantities.push_back(judge("scale", std::expm1(size.value[0]), size.deviation[0], kScaleLimit, 100,
                             "% of the marker's size", 3,
                             "its print has another size, its axis another scale, or the camera has moved: measure "
                             "the print, then calibrate the axis with stops"));
  quantities.push_back(judge("perspective", 2 * size.value[1], 2 * size.deviation[1], kPerspectiveLimit, 100,
                             "% of size from one end to the other", 3,
                             "the axis is slanted otherwise against the sensor: calibrate it with stops"));
  quantities.push_back(judge("lens", size.value[2], size.deviation[2], kLensLimit, 100,
                             "% of size from the lens' centre to half of the path away", 3,
                             "focal length or distortion is another: calibrate the lens"));
}

void InstrumentCheck::addPath(const Course& path, double half, std::vector<CheckedQuantity>& quantities) const {
  const double metre = config_.axis.pixels_per_metre;
  quantities.push_back(judge("direction", std::atan(path.value[1] / half), path.deviation[1] / half, kDirectionLimit,
                             1 / kDegree, "deg", 3, "camera or guide has turned: calibrate the axis"));
  quantities.push_back(judge("across", path.value[0] / metre, path.deviation[0] / metre,
                             kAcrossLimit * config_.lateral_tolerance, 1e3, "mm across the axis", 3,
                             "camera or guide has moved: calibrate the axis"));
  quantities.push_back(judge("path", path.value[2] / metre, path.deviation[2] / metre, kPathLimit, 1e3,
                             "mm bow of the path", 3,
                             "the lens is another, if the guide is straight: calibrate the lens"));
}

std::uint64_t InstrumentCheck::framesWith(Doubt doubt) const {
  const auto found = doubts_.find(doubt);
  return found == doubts_.end() ? 0 : found->second;
}

double InstrumentCheck::share(Doubt doubt) const {
  return tracked_ == 0 ? 0 : static_cast<double>(framesWith(doubt)) / static_cast<double>(tracked_);
}

/// Doubts that a tracker names first, so that the others are not seen.
std::string InstrumentCheck::hidden(Doubt doubt) const {
  for (const Doubt first : {Doubt::Shutter, Doubt::Size, Doubt::Askew, Doubt::Bent}) {
    if (first == doubt) break;
    if (share(first) > kHides) return toWord(first);
  }
  return "";
}

std::string InstrumentCheck::whyUnknown(Doubt doubt) const {
  const std::string other = hidden(doubt);
  if (!other.empty()) return "hidden by '" + other + "'; mend that first";
  if (tracked_ < kEnough) return "seen in " + std::to_string(tracked_) + " frames; give at least 30";
  if (doubt == Doubt::Response) return "";
  if (fast_ < kEnough)
    return "faster than 50 mm/s in " + std::to_string(fast_) + " frames; move it fast for some seconds";
  if (doubt == Doubt::Askew && most_turn_ - least_turn_ < kTurn)
    return "turned by " + withDecimals((most_turn_ - least_turn_) / kDegree, 0) + " deg; turn it by half a turn";
  if (doubt == Doubt::Shutter && fastest_ == 0) return "not checked yet; move it fast for some seconds";
  return "";
}

/// @param wrong  quantity of the geometry that is wrong: it makes a marker look askew or bent
CheckedQuantity InstrumentCheck::judgeDoubt(Doubt doubt, const std::string& wrong) const {
  CheckedQuantity q{toWord(doubt), Verdict::Holds, share(doubt), 0, kDoubtful, ""};
  const std::string frames = std::to_string(framesWith(doubt)) + " of " + std::to_string(tracked_) + " frames doubted";
  const std::string unknown = whyUnknown(doubt);
  q.text = frames;
  if (q.value > kDoubtful && !wrong.empty() && (doubt == Doubt::Askew || doubt == Doubt::Bent)) {
    q.verdict = Verdict::Unknown;
    q.text += ", which may come of '" + wrong + "'; mend that first";
  } else if (q.value > kDoubtful) {
    q.verdict = Verdict::Wrong;
    q.text += "; " + std::string(toText(doubt));
  } else if (!unknown.empty()) {
    q.verdict = Verdict::Unknown;
    q.text = unknown;
  } else if (doubt == Doubt::Shutter) {
    q.deviation = kUnchecked * std::sqrt(3.0) / (fastest_ * height_);
    q.text += ", rows at most " + withDecimals(1e6 * q.deviation, 1) + " us apart (one standard deviation)";
  }
  return q;
}

}  // namespace vibe::vision
