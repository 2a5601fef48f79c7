#include <cmath>

#include "synthetic/degradation.hpp"
#include "vibe_vision/synthetic/synthetic_scene.hpp"
#include "vibe_vision/tag/tag_reader.hpp"

namespace vibe::vision {
namespace {

/// A point of the marker, from -1 to 1 in both directions; false: none there.
bool markerPoint(const SyntheticInstrument& instrument, const MarkerFrame& frame, double a, double b,
                 Eigen::Vector3d& point) {
  Eigen::Vector2d half = halfExtents(instrument);
  double height = 0;
  if (instrument.tag.cells > 0) {
    half.setConstant(instrument.tag.side / 2 * instrument.scale);
  } else if (const auto* ring = std::get_if<RingDesign>(&instrument.nominal.marker)) {
    if (a * a + b * b > 1) return false;
    half.setConstant(ring->outer_diameter / 2 * instrument.scale);
  } else {
    height = half.y() * std::sqrt(1 - b * b);
  }
  point = frame.centre + a * half.x() * frame.along + b * half.y() * frame.across - height * frame.away;
  return true;
}

double visibleShare(const SyntheticScene& scene, const SyntheticInstrument& instrument, double time) {
  constexpr int kPoints = 40;
  const MarkerFrame frame = markerFrame(scene.camera, instrument, time);
  const Occluder occluder(scene);
  int all = 0, seen = 0;
  for (int i = 0; i < kPoints; ++i)
    for (int j = 0; j < kPoints; ++j) {
      Eigen::Vector3d point;
      if (!markerPoint(instrument, frame, (2 * i + 1.0) / kPoints - 1, (2 * j + 1.0) / kPoints - 1, point)) continue;
      ++all;
      const Eigen::Vector2d pixel = project(scene.camera, point);
      const bool inside = pixel.x() >= -0.5 && pixel.y() >= -0.5 && pixel.x() < scene.camera.width - 0.5 &&
                          pixel.y() < scene.camera.height - 0.5;
      const bool covered =
          occluder.present && std::abs(pixel.x() - occluder.middle(time, pixel.y())) < occluder.half_width;
      if (inside && !covered) ++seen;
    }
  return static_cast<double>(seen) / all;
}

}  // namespace

SyntheticTruth truthAt(const SyntheticScene& scene, std::size_t instrument, double time) {
  const SyntheticInstrument& object = scene.instruments.at(instrument);
  const SlideAxis& axis = object.nominal.axis;
  const auto ideal = [&](double t) { return projectIdeal(scene.camera, markerFrame(scene.camera, object, t).centre); };
  const Eigen::Vector2d centre = ideal(time), offset = centre - axis.origin;
  SyntheticTruth truth;
  truth.slide = object.motion.slide(time);
  truth.rotation = object.motion.rotation ? object.motion.rotation(time) : 0;
  truth.along = offset.dot(axis.direction);
  truth.lateral = axis.direction.x() * offset.y() - axis.direction.y() * offset.x();
  truth.pixel = distort(scene.camera, centre);
  constexpr double kStep = 1e-5;  // [s]
  truth.velocity = (ideal(time + kStep) - ideal(time - kStep)).dot(axis.direction) / (2 * kStep);
  truth.visible = visibleShare(scene, object, time);
  return truth;
}

void writeTruth(std::ostream& table, std::uint64_t sequence, double stamp, const std::string& instrument,
                const SyntheticTruth& t) {
  table << sequence << ',' << stamp << ',' << instrument;
  for (const double value : {t.slide, t.rotation, t.along, t.lateral, t.pixel.x(), t.pixel.y(), t.velocity, t.visible})
    table << ',' << value;
  table << '\n';
}

void setTag(SyntheticInstrument& instrument, const TagDesign& tag) {
  instrument.nominal.marker = tag;
  instrument.tag = {tagCells(tag.family), tagPicture(tag), tag.side};
}

}  // namespace vibe::vision
