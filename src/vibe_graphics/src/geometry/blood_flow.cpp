#include "vibe_graphics/geometry/blood_flow.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "vibe_graphics/geometry/basins.hpp"
#include "vibe_graphics/geometry/blood_colour.hpp"
#include "vibe_graphics/geometry/tube.hpp"

namespace vibe::graphics {

namespace {

using Eigen::Vector3d;

constexpr double kGravity = 9.81;         // [m/s^2]
constexpr double kHeartRate = 72 / 60.0;  // [1/s]
constexpr double kMeanSpeed = 0.5;   // of blood leaving a small artery into gas [m/s]; rises some 13 mm; design choice
constexpr double kPulse = 0.3;       // part of the speed that pulses
constexpr double kMinJet = 0.55e-3;  // [m]
constexpr int kJetPoints = 24;

/// Path of blood with the mean initial speed, slightly oblique so that it does not fall back onto itself.
struct Flight {
  Vector3d leave;  // unit

  Vector3d at(double t, double speed, const Vector3d& from, const Vector3d& down) const {
    return from + speed * t * leave + 0.5 * kGravity * t * t * down;
  }
};

Flight flightOf(const Wound& wound, const Vector3d& down) {
  const Vector3d inward = wound.inward.norm() > 0.5 ? wound.inward : Vector3d(-down);
  const Vector3d aside = Eigen::AngleAxisd(M_PI * wobble(wound.number, 9), inward) * anyNormal(inward);
  return {(inward + 0.45 * aside).normalized()};
}

}  // namespace

double jetSpeed(double time) {
  const double beat = time * kHeartRate, phase = 2 * M_PI * (beat - std::floor(beat));
  return kMeanSpeed * (1 + kPulse * (std::sin(phase) + 0.5 * std::sin(2 * phase)));
}

double jetDuration(const Wound& wound, double drop, const BloodStyle& style) {
  const double rising = -kMeanSpeed * flightOf(wound, style.down).leave.dot(style.down);  // against gravity [m/s]
  return (rising + std::sqrt(rising * rising + 2 * kGravity * drop)) / kGravity;
}

std::vector<Vector3d> jetPath(const Wound& wound, double duration, const BloodStyle& style) {
  const Flight flight = flightOf(wound, style.down);
  std::vector<Vector3d> line;
  for (int k = 0; k < kJetPoints; ++k)
    line.push_back(flight.at(duration * k / (kJetPoints - 1), kMeanSpeed, wound.place, style.down));
  return line;
}

std::vector<Vector3d> jetLine(const Wound& wound, double duration, const BloodStyle& style) {
  const Flight flight = flightOf(wound, style.down);
  std::vector<Vector3d> line;
  for (int k = 0; k < kJetPoints; ++k) {
    const double t = duration * k / (kJetPoints - 1);
    line.push_back(flight.at(t, jetSpeed(style.time - t), wound.place, style.down));
  }
  return line;
}

void appendJet(const Wound& wound, const std::vector<Vector3d>& line, const BloodStyle& style, ColouredShape& shape) {
  constexpr std::size_t kWhole = 15;
  const double steady = std::sqrt(wound.rate / (M_PI * kMeanSpeed));
  const double radius = std::max(kMinJet, steady) * std::sqrt(style.emphasis);
  std::vector<TubePoint> jet;
  for (std::size_t k = 0; k < kWhole; ++k) {
    const double swell = 1 + 0.35 * std::sin(2 * M_PI * (0.19 * static_cast<double>(k) - style.time * 5));
    jet.push_back({line[k], radius * swell * (1 - 0.3 * static_cast<double>(k) / kWhole), packedOf(kBrightBlood)});
  }
  appendTube(jet, 8, shape);
  // drops differ in size and deviate from the path
  for (std::size_t k = kWhole; k < line.size(); ++k) {
    const auto number = static_cast<int>(3 * k);
    const Vector3d stray(wobble(wound.number, number), wobble(wound.number, number + 1),
                         wobble(wound.number, number + 2));
    const double size = 0.95 + 0.5 * wobble(wound.number + 7, number);
    appendBall(line[k] + 1.3 * radius * stray, radius * size, packedOf(kBrightBlood), 8, shape);
  }
}

namespace {

using Eigen::Vector3d;

// Design choices, so that a bleeding looks as it is described: a red streak and a pool.
constexpr double kFarthestWall = 8e-3;                            // farthest wall that a wound can belong to [m]
constexpr double kFilmVolume = 8e-9, kCeilingFilmVolume = 25e-9;  // what clings to a wall, and to one overhead [m^3]
constexpr double kCling = 60e-9;              // of a brisk wound, that does not leave with the jet [m^3]
constexpr double kFlatCeiling = 0.94;         // cosine to gravity from which blood does not run
constexpr double kFall = 0.3, kClear = 1e-3;  // longest fall, and where it begins before the wall [m]
constexpr int kFalls = 3;                     // from fold to fold
constexpr int kOtherNumbers = 100;            // so that blood that has landed differs in shape

/// How blood of a wound runs.
struct Run {
  double width, thickness;  // [m]
  double speed;             // of the head [m/s]
};
constexpr Run kMild{2.2e-3, 0.40e-3, 8e-3}, kBrisk{3.8e-3, 0.60e-3, 40e-3};

/// Some blood of a wound at a point of the wall.
struct Source {
  WallPlace at;
  double volume;  // [m^3]
  double age;     // since it has been there [s]
  Run run;
  double brown;
  int number;
};

double lengthOnWall(const std::vector<WallPlace>& line) {
  double length = 0;
  for (std::size_t k = 1; k < line.size(); ++k) length += (line[k].place - line[k - 1].place).norm();
  return length;
}

/// Cuts a line on a wall; the last point is between two of its points.
std::vector<WallPlace> beginningOnWall(const std::vector<WallPlace>& line, double length, const WallSurface& wall) {
  std::vector<WallPlace> cut(1, line.front());
  for (std::size_t k = 1; k < line.size() && length > 0; ++k) {
    const Vector3d way = line[k].place - line[k - 1].place;
    const double step = way.norm();
    cut.push_back(step <= length ? line[k] : wall.moved(line[k - 1], length / step * way));
    length -= step;
  }
  return cut;
}

/// How far the head has come, and the line up to there.
Rivulet rivuletOf(const Source& source, double volume, const WallSurface& wall, const Vector3d& down) {
  Rivulet rivulet;
  rivulet.width = source.run.width, rivulet.thickness = source.run.thickness;
  rivulet.brown = source.brown, rivulet.number = source.number;
  const std::vector<WallPlace> whole = steepestDescent(wall, source.at, down);
  const double path = lengthOnWall(whole), section = 2.0 / 3 * rivulet.width * rivulet.thickness;
  rivulet.length = std::min({path, source.run.speed * std::max(0.0, source.age), volume / section});
  rivulet.arrived = rivulet.length >= path;
  rivulet.line = rivulet.arrived ? whole : beginningOnWall(whole, rivulet.length, wall);
  return rivulet;
}

class FlowBuilder {
 public:
  FlowBuilder(const WallSurface& wall, const BloodStyle& style)
      : wall_(wall), style_(style), basins_(wall, style.down) {}

  void add(const Wound& wound) {
    const auto at = wall_.nearest(wound.place, wound.inward, kFarthestWall);
    if (!at) {
      flow_.elsewhere.push_back(wound);
      return;
    }
    const double cling = wound.brisk ? std::min(wound.amount, kCling) : wound.amount;
    addSource({*at, cling, wound.age, kMild, brownOf(wound), wound.number}, !wound.brisk);
    if (wound.brisk) addJet(wound, *at, wound.amount - cling);
  }

  BloodFlow finished() {
    flow_.pools = basins_.pools();
    for (const Brim& brim : basins_.brims()) {
      const auto number = static_cast<int>(brim.vertex);
      const Source source{wall_.atVertex(brim.vertex), 1, kFall / kMild.speed, kMild, brim.brown, number};
      flow_.rivulets.push_back(rivuletOf(source, 1, wall_, style_.down));
      ++flow_.passing;
    }
    for (Rivulet& rivulet : flow_.rivulets) endAtPool(rivulet);
    return std::move(flow_);
  }

 private:
  /// What is deep in a pool would shine through it.
  void endAtPool(Rivulet& rivulet) const {
    const auto isIn = [&](const WallPlace& point, const Pool& pool) {
      return point.place.dot(-style_.down) < pool.level - rivulet.thickness &&
             std::find(pool.triangles.begin(), pool.triangles.end(), point.triangle) != pool.triangles.end();
    };
    for (const Pool& pool : flow_.pools)
      while (rivulet.line.size() > 2 && isIn(rivulet.line.back(), pool)) rivulet.line.pop_back();
  }

  /// A film, a rivulet, and what is left at its end.
  /// @param goes_on  false: what is left stays at the source
  void addSource(const Source& source, bool goes_on, int falls = 0) {
    const bool overhead = source.at.inward.dot(style_.down) > kFlatCeiling;
    BloodFilm film{source.at, std::min(source.volume, overhead ? kCeilingFilmVolume : kFilmVolume), source.brown,
                   source.number};
    double rest = source.volume - film.volume;
    WallPlace end = source.at;
    bool arrived = true;
    double since = source.age;
    if (!overhead && rest > 0) {
      Rivulet rivulet = rivuletOf(source, rest, wall_, style_.down);
      rest = std::max(0.0, rest - rivulet.volume());
      since -= rivulet.length / source.run.speed;
      end = rivulet.line.back(), arrived = rivulet.arrived;
      if (rivulet.line.size() > 1) flow_.rivulets.push_back(std::move(rivulet));
    }
    if (arrived && goes_on && rest > 0)
      rest = letGo({end, rest, since, source.run, source.brown, source.number}, falls);
    film.volume += rest;
    if (film.volume > 0) flow_.films.push_back(film);
  }

  /// At the end of a rivulet blood stands, or falls if the wall is overhead. @return  what finds no place [m^3]
  double letGo(Source source, int falls) {
    if (source.at.inward.dot(style_.down) < 0) {
      basins_.pour(bottomBelow(wall_, source.at, style_.down), source.volume, source.brown);
      return 0;
    }
    const Vector3d from = source.at.place + kClear * source.at.inward;
    double along = 0;
    const auto below = wall_.landing({from, from + kFall * style_.down}, along);
    if (!below || falls >= kFalls) return source.volume;
    source.at = *below;
    source.number += kOtherNumbers;
    addSource(source, true, falls + 1);
    return 0;
  }

  void addJet(const Wound& wound, const WallPlace& at, double volume) {
    Wound source = wound;
    source.place = at.place, source.inward = at.inward;
    const double longest = jetDuration(source, kFall, style_);
    const std::vector<Vector3d> path = jetPath(source, longest, style_);
    double along = 0;
    const auto landing = wall_.landing(path, along);
    const double duration =
        landing ? longest * along / static_cast<double>(path.size() - 1) : jetDuration(source, 0.05, style_);
    if (wound.rate > 0) flow_.jets.push_back({source, duration});
    const Source below{landing ? *landing : at,     volume, wound.age, kBrisk, brownOf(wound),
                       wound.number + kOtherNumbers};
    if (volume > 0) addSource(below, landing.has_value());
  }

  const WallSurface& wall_;
  const BloodStyle& style_;
  Basins basins_;
  BloodFlow flow_;
};

}  // namespace

BloodFlow flowOf(const std::vector<Wound>& wounds, const WallSurface& wall, const BloodStyle& style) {
  FlowBuilder builder(wall, style);
  for (const Wound& wound : wounds)
    if (wound.amount > 0 || wound.rate > 0) builder.add(wound);
  return builder.finished();
}

}  // namespace vibe::graphics
