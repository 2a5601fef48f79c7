#include "geometry/blood_flow.hpp"

#include <algorithm>
#include <cmath>

#include "geometry/blood_colour.hpp"
#include "geometry/blood_jet.hpp"
#include "geometry/descent.hpp"

namespace vibe::rviz_plugins {
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

}  // namespace vibe::rviz_plugins
