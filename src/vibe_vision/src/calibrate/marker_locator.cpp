#include "vibe_vision/calibrate/marker_finder.hpp"

#include <algorithm>

#include "calibrate/fitting.hpp"
#include "vibe_core/program/error.hpp"
#include "vibe_vision/tag/tag_reader.hpp"
#include "vibe_vision/track/tracker.hpp"

namespace vibe::vision {
namespace {

constexpr double kMargin = 1.5e-3;                          // around the rough place [m]
constexpr double kShifts[] = {0, 1, -1, 2, -2, 0.5, -0.5};  // of the rough axis to the side, until it is found [px]
constexpr double kRoughLateral = 2e-3;                      // [m]
constexpr double kRoughScaleError = 0.3;
constexpr int kRepeats = 8;           // of each image
constexpr double kRepeatTime = 0.01;  // [s]
constexpr int kPasses = 3;            // each with the axis of the one before

/// A configuration with this instrument alone, whose axis is a piece around a place.
VisionConfig pieceOf(const VisionConfig& config, std::size_t instrument, const Eigen::Vector2d& place,
                     const Eigen::Vector2d& direction, double pixels_per_metre) {
  VisionConfig piece = config;
  piece.instruments = {config.instruments[instrument]};
  InstrumentConfig& object = piece.instruments.front();
  object.axis = {};
  object.axis.origin = place;
  object.axis.direction = direction;
  object.axis.pixels_per_metre = pixels_per_metre;
  object.lower = -kMargin, object.upper = kMargin;
  return piece;
}

void allowRoughPlace(VisionConfig& piece) {
  double& tolerance = piece.instruments.front().lateral_tolerance;
  tolerance = std::max(tolerance, kRoughLateral);
}

/// Whether the tracker, which knows the whole marker, sees it at a place.
bool isMarker(const VisionConfig& config, std::size_t instrument, const Frame& image, const MarkerSighting& sighting) {
  const Eigen::Vector2d place = undistort(config.camera, sighting.pixel);
  if (!place.allFinite()) return false;  // the lens does not show it
  VisionConfig piece = pieceOf(config, instrument, place, sighting.direction, sighting.pixels_per_metre);
  allowRoughPlace(piece);
  Tracker tracker(piece);
  return tracker.track(image).front().tracked();
}

/// The search of whole images.
struct RoughResult {
  std::vector<LocatedMarker> markers;
  Eigen::Vector2d sleeve_direction = Eigen::Vector2d::Zero();
};

RoughResult searchImages(const VisionConfig& config, std::size_t instrument, const std::vector<Frame>& images,
                         const MarkerSearch& search) {
  const MarkerDesign& design = config.instruments[instrument].marker;
  MarkerFinder finder(design, search);
  RoughResult result;
  for (const Frame& image : images) {
    LocatedMarker marker;
    marker.problem = "nothing in the image looks like the marker";
    const auto confirm = [&](const MarkerSighting& place) { return isMarker(config, instrument, image, place); };
    if (const auto sighting = finder.find(image.image, confirm)) {
      marker.found = true;
      marker.pixel = undistort(config.camera, sighting->pixel);
      marker.pixels_per_metre = sighting->pixels_per_metre;
      if (std::holds_alternative<SleeveDesign>(design)) result.sleeve_direction += sighting->direction;
    }
    result.markers.push_back(marker);
  }
  return result;
}

/// A configuration with this instrument alone, on the line through the markers found so far.
VisionConfig roughConfig(const VisionConfig& config, std::size_t instrument, const LocatedMarkers& located, int pass) {
  std::vector<Eigen::Vector2d> points;
  std::vector<double> scales;
  for (const LocatedMarker& marker : located.markers) {
    if (!marker.found) continue;
    points.push_back(marker.pixel);
    scales.push_back(marker.pixels_per_metre);
  }
  StraightLine line = StraightLine::fit(points);
  if (line.direction.dot(located.direction) < 0) line.direction = -line.direction;
  VisionConfig rough = pieceOf(config, instrument, line.point, line.direction, median(scales));
  if (pass > 0) return rough;
  allowRoughPlace(rough);
  rough.gates.max_scale_error = std::max(rough.gates.max_scale_error, kRoughScaleError);
  return rough;
}

LocatedMarker toLocated(const Measurement& m, const SlideAxis& axis) {
  LocatedMarker marker;
  marker.found = m.tracked();
  if (!marker.found) {
    marker.problem = toText(m.reason);
    return marker;
  }
  marker.pixel = pixelAt(axis, m.along, m.lateral);
  marker.pixels_per_metre = m.scale * pixelsPerMetre(axis, m.slide);
  marker.rotation = m.rotation;
  marker.ink = m.ink;
  return marker;
}

/// The same image a few times, as if the instrument stood still: what the tracker learns slowly, such as the place
/// across the axis, settles.
LocatedMarker settle(Tracker& tracker, Frame image, const SlideAxis& axis) {
  LocatedMarker marker;
  for (int i = 0; i < kRepeats; ++i) {
    const LocatedMarker next = toLocated(tracker.track(image).front(), axis);
    if (!next.found && !marker.found) return next;
    if (next.found) marker = next;
    image.stamp += kRepeatTime;
    ++image.sequence;
  }
  return marker;
}

/// Tracks one image on a piece of the axis around the rough place.
LocatedMarker measure(VisionConfig config, const Frame& image, const Eigen::Vector2d& rough) {
  InstrumentConfig& object = config.instruments.front();
  const Eigen::Vector2d across = acrossOf(object.axis), origin = object.axis.origin;
  const double slide = slideOf(object.axis, (rough - origin).dot(object.axis.direction));
  object.lower = slide - kMargin;
  object.upper = slide + kMargin;
  LocatedMarker marker;
  for (const double shift : kShifts) {
    object.axis.origin = origin + shift * across;
    Tracker tracker(config);
    marker = settle(tracker, image, object.axis);
    if (marker.found) break;
  }
  return marker;
}

void requireTwo(const LocatedMarkers& located, const std::string& name) {
  const auto found = std::count_if(located.markers.begin(), located.markers.end(),
                                   [](const LocatedMarker& marker) { return marker.found; });
  if (found >= 2) return;
  const std::string why = found == 0 && !located.markers.empty() && !located.markers[0].problem.empty()
                              ? " (" + located.markers[0].problem + ")"
                              : "";
  throw Error("the marker of '" + name + "' was found in " + std::to_string(found) + " of " +
              std::to_string(located.markers.size()) + " images" + why +
              "; check that it is the one of the configuration, sharp, lit, and within the scale to look for");
}

/// Tags are read, each image by itself.
LocatedMarkers readTags(const VisionConfig& config, const InstrumentConfig& object, const TagDesign& tag,
                        const std::vector<Frame>& images, const MarkerSearch& search) {
  TagReader reader(tag, search.lowest_scale);  // until the size is known, on which the reading of corners depends
  bool sized = false;
  LocatedMarkers located;
  for (const Frame& image : images) {
    LocatedMarker marker;
    std::vector<TagCorners> tags = reader.find(image.image);
    if (!sized && tags.size() == 1) {
      reader = TagReader(tag, TagPlace::of(config.camera, tags[0], {0, 0}, tag.side).pixels_per_metre);
      tags = reader.find(image.image);
      sized = true;
    }
    marker.problem = tags.empty() ? "the tag is not read in the image" : "two tags have this number";
    if (tags.size() == 1) {
      const TagPlace place = TagPlace::of(config.camera, tags[0], {0, 0}, tag.side);
      marker = {true, "", place.centre, place.pixels_per_metre, 0};
    }
    located.markers.push_back(marker);
  }
  requireTwo(located, object.name);
  return located;
}

}  // namespace

LocatedMarkers locateMarkers(const VisionConfig& config, std::size_t instrument, const std::vector<Frame>& images,
                             const MarkerSearch& search) {
  for (const Frame& image : images)
    requireSize(config.camera, image.image.width, image.image.height, "an image has",
                "take the images with the calibrated camera and the same region");
  const InstrumentConfig& object = config.instruments.at(instrument);
  if (const auto* tag = std::get_if<TagDesign>(&object.marker)) return readTags(config, object, *tag, images, search);
  const RoughResult rough = searchImages(config, instrument, images, search);
  LocatedMarkers located{rough.markers, rough.sleeve_direction};
  for (int pass = 0; pass < kPasses; ++pass) {
    requireTwo(located, object.name);
    const VisionConfig line = roughConfig(config, instrument, located, pass);
    for (std::size_t i = 0; i < images.size(); ++i) {
      if (rough.markers[i].found) located.markers[i] = measure(line, images[i], rough.markers[i].pixel);
    }
  }
  requireTwo(located, object.name);
  std::vector<double> inks;
  for (const LocatedMarker& marker : located.markers)
    if (marker.found) inks.push_back(marker.ink);
  located.ink = median(inks);
  return located;
}

}  // namespace vibe::vision
