#include "vibe_graphics/geometry/suture_shapes.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "geometry/suture_ends.hpp"
#include "vibe_graphics/geometry/solid_bodies.hpp"
#include "vibe_graphics/geometry/tube.hpp"

namespace vibe::graphics {
namespace {

using Eigen::Vector3d;

constexpr int kSymbolSides = 16;

// Symbols [m].
constexpr double kBiteRadius = 1.3e-3, kBiteThickness = 0.28e-3;
constexpr double kPartialRadius = 0.75e-3;
constexpr double kCornerRadius = 2.3e-3;

constexpr PackedColour kFullBite = packed(0.55, 0.95, 0.55);
constexpr PackedColour kPartialBite = packed(1.0, 0.55, 0.05);
constexpr PackedColour kCorner = packed(0.98, 0.20, 0.80);
constexpr PackedColour kBroken = packed(0.35, 0.35, 0.38);
constexpr double kBand = 2e-3;  // length of a band of slack thread [m]

PackedColour darker(PackedColour colour, double part) {
  const auto channel = [&](int k) { return part * ((colour >> (8 * k)) & 0xff) / 255; };
  return packed(channel(0), channel(1), channel(2), ((colour >> 24) & 0xff) / 255.0);
}

PackedColour pieceColour(const ThreadPiece& piece, std::size_t number, const SutureStyle& style) {
  if (style.colouring == ThreadColour::One) return style.one_colour;
  if (style.colouring == ThreadColour::PerSuture) return sutureColour(number);
  return piece.tension > 0 ? style.tension_map.at(piece.tension) : style.slack_colour;
}

double lengthOf(const std::vector<Vector3d>& line) {
  double length = 0;
  for (std::size_t k = 1; k < line.size(); ++k) length += (line[k] - line[k - 1]).norm();
  return length;
}

/// Cuts a line into an odd number of bands of about the requested length, each with its own first and last point.
std::vector<std::vector<Vector3d>> bandsOf(const std::vector<Vector3d>& line, double wanted) {
  const double whole = lengthOf(line);
  const int bands = 2 * static_cast<int>(std::min(100.0, whole / wanted / 2)) + 1;
  const double band = whole / bands;
  std::vector<std::vector<Vector3d>> result(1, {line.front()});
  double done = 0;
  for (std::size_t k = 1; k < line.size(); ++k) {
    const double step = (line[k] - line[k - 1]).norm();
    double end = band * static_cast<double>(result.size());
    while (end < done + step && static_cast<int>(result.size()) < bands) {
      const Vector3d cut = line[k - 1] + (end - done) / step * (line[k] - line[k - 1]);
      result.back().push_back(cut);
      result.push_back({cut});
      end = band * static_cast<double>(result.size());
    }
    result.back().push_back(line[k]);
    done += step;
  }
  return result;
}

void appendPiece(const ThreadPiece& piece, std::size_t number, const SutureStyle& style, ColouredShape& shape) {
  if (piece.line.empty()) return;
  const PackedColour colour = pieceColour(piece, number, style);
  if (piece.tension > 0 || !style.slack_bands)
    return appendTube(piece.line, style.threadRadius(), colour, kThreadSides, shape);
  const auto bands = bandsOf(piece.line, kBand * std::max(1.0, style.emphasis / 2));
  for (std::size_t k = 0; k < bands.size(); ++k)
    appendTube(bands[k], style.threadRadius(), k % 2 == 0 ? colour : darker(colour, 0.55), kThreadSides, shape);
}

bool isHeld(const SutureSet& set, std::size_t bite) {
  return (set.has_cinch && bite == 0) || (set.has_t_tag && bite + 1 == set.bites.size());
}

/// A full-thickness bite is a ring around the thread, a partial one a ball, so that they differ from all sides. At a
/// cinch or T-tag, the ring is wider and surrounds it.
void appendBite(const SutureSet& set, std::size_t number, bool held, double size, ColouredShape& shape) {
  const SutureBite& bite = set.bites[number];
  const PackedColour colour = bite.full_thickness ? kFullBite : kPartialBite;
  if (!bite.full_thickness && !held) return appendBall(bite.place, kPartialRadius * size, colour, kThreadSides, shape);
  appendRing(bite.place, biteAxis(set, number), (held ? 1.6 : 1.0) * kBiteRadius * size, kBiteThickness * size, colour,
             kSymbolSides, shape);
}

/// @param size  factor of the thickness of symbols
void appendEnds(const SutureSet& set, std::size_t number, const SutureStyle& style, double size, ColouredShape& shape) {
  const auto held = [&](bool last) {
    const ThreadPiece none;
    const ThreadPiece& piece = set.pieces.empty() ? none : last ? set.pieces.back() : set.pieces.front();
    return HeldThread{pieceColour(piece, number, style), style.threadRadius()};
  };
  if (set.has_t_tag) appendTag(set, size, held(true), shape);
  if (set.has_cinch) appendCinch(set, size, held(false), shape);
}

void appendSet(const SutureSet& set, std::size_t number, const SutureStyle& style, ColouredShape& shape) {
  const double size = std::sqrt(std::max(style.emphasis, 0.01));  // symbols are large already
  for (const ThreadPiece& piece : set.pieces) appendPiece(piece, number, style, shape);
  for (std::size_t k = 0; style.bites && k < set.bites.size(); ++k)
    appendBite(set, k, style.ends && isHeld(set, k), size, shape);
  if (style.ends) appendEnds(set, number, style, size, shape);
  for (std::size_t k = 0; style.corners && k < set.corners.size(); ++k)
    appendRing(set.bites[set.corners[k]].place, biteAxis(set, set.corners[k]), kCornerRadius * size,
               1.3 * kBiteThickness * size, kCorner, kSymbolSides, shape);
}

/// Two-sided: the material draws both.
void appendBand(const Vector3d& from, const Vector3d& to, const Vector3d& across, const Vector3d& normal,
                PackedColour colour, ColouredShape& shape) {
  const auto first = static_cast<std::uint32_t>(shape.vertices.size());
  const Eigen::Vector3f n = normal.cast<float>();
  for (const Vector3d& corner :
       {Vector3d(from - across), Vector3d(from + across), Vector3d(to - across), Vector3d(to + across)}) {
    const Eigen::Vector3f p = corner.cast<float>();
    shape.vertices.push_back({{p.x(), p.y(), p.z()}, {n.x(), n.y(), n.z()}});
    shape.colours.push_back(colour);
  }
  shape.triangles.insert(shape.triangles.end(), {first, first + 1, first + 3, first, first + 3, first + 2});
}

void appendLink(const SutureSet& set, std::size_t link, double width, ColouredShape& shape) {
  constexpr double kDash = 3e-3;
  const Vector3d& from = set.bites[set.links[link].first].place;
  const Vector3d& to = set.bites[set.links[link].second].place;
  const double length = (to - from).norm();
  if (!(length > 0)) return;
  const Vector3d along = (to - from) / length, flat = planeNormal(set);
  const Vector3d across =
      0.5 * width * (flat.cross(along).norm() > 1e-3 ? Vector3d(flat.cross(along).normalized()) : anyNormal(along));
  const Vector3d normal = along.cross(across).normalized();
  const PackedColour colour = link % 2 == 0 ? packed(0.20, 0.85, 0.95) : packed(1.0, 0.85, 0.25);
  const int dashes = std::max(1, static_cast<int>(std::min(100.0, length / kDash / 2 + 0.5)));
  for (int k = 0; k < dashes; ++k)
    appendBand(from + along * (length * (2 * k + 0.5) / (2 * dashes)),
               from + along * (length * (2 * k + 1.5) / (2 * dashes)), across, normal, colour, shape);
}

}  // namespace

SutureStyle naturalSutures() {
  SutureStyle style;
  style.colouring = ThreadColour::One;
  style.one_colour = packed(0.16, 0.36, 0.90);  // dyed polypropylene
  style.bites = style.corners = style.links = style.slack_bands = false;
  return style;
}

PackedColour sutureColour(std::size_t number) {
  // ColorBrewer "Paired" (Brewer 2003, Apache 2.0), the strong ones first
  constexpr std::array<PackedColour, 12> kColours{
      packed(0.12, 0.47, 0.71), packed(0.20, 0.63, 0.17), packed(1.00, 0.50, 0.00), packed(0.42, 0.24, 0.60),
      packed(0.69, 0.35, 0.16), packed(0.65, 0.81, 0.89), packed(0.70, 0.87, 0.54), packed(0.99, 0.75, 0.44),
      packed(0.79, 0.70, 0.84), packed(1.00, 1.00, 0.60), packed(0.89, 0.10, 0.11), packed(0.98, 0.60, 0.60)};
  return kColours[number % kColours.size()];
}

void appendSutures(const SutureDrawing& scene, const SutureStyle& style, ColouredShape& shape) {
  for (std::size_t k = 0; k < scene.sets.size(); ++k) appendSet(scene.sets[k], k, style, shape);
}

void appendLinks(const SutureDrawing& scene, const SutureStyle& style, ColouredShape& shape) {
  if (!style.links) return;
  for (const SutureSet& set : scene.sets)
    for (std::size_t k = 0; k < set.links.size(); ++k)
      appendLink(set, k, 1.2e-3 * std::sqrt(std::max(style.emphasis, 0.01)), shape);
}

std::string labelOf(const SutureSet& set, std::size_t number) {
  std::string text = std::to_string(number + 1) + ": ";
  if (set.technique.empty())
    return text + std::to_string(set.bites.size()) + (set.bites.size() == 1 ? " bite" : " bites");
  const bool letter = set.technique.size() == 1;
  text += letter ? std::string(1, static_cast<char>(std::toupper(set.technique.front()))) : set.technique;
  char margin[16];
  std::snprintf(margin, sizeof margin, " %.2f", set.margin);
  text += margin;
  if (set.stage == SutureStage::Broken) text += ", broken";
  if (set.loose) text += ", loose";
  if (set.tear_outs > 0) text += ", " + std::to_string(set.tear_outs) + " torn out";
  return text;
}

Vector3d labelPlace(const SutureSet& set, double distance) {
  Vector3d middle = Vector3d::Zero(), inward = Vector3d::Zero();
  if (set.bites.empty()) return middle;
  for (const SutureBite& bite : set.bites) middle += bite.place, inward += bite.inward;
  middle /= static_cast<double>(set.bites.size());
  return inward.norm() > 1e-6 ? Vector3d(middle + distance * inward.normalized()) : middle;
}

}  // namespace vibe::graphics
