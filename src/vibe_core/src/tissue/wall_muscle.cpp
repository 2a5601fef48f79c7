#include "tissue/wall_muscle.hpp"

#include <algorithm>
#include <cmath>

#include "arithmetic/elementary.hpp"
#include "arithmetic/turn.hpp"
#include "geometry/regions.hpp"
#include "tissue/shell_tissue.hpp"
#include "vibe_core/program/error.hpp"

namespace vibe {

namespace {

constexpr double kWaveStart = 0.45;       // along the axis: mid corpus
constexpr double kWaveGrown = 0.75;       // along the axis: where a wave is as deep as it gets. Design choice
constexpr double kStartSpeed = 0.45;      // at mid corpus over that in the distal antrum: 1.6 mm/s in the proximal one
constexpr double kDistal = 0.06;          // of the antrum before the pylorus, in which the speed is the same [m]
constexpr double kNarrowing = 0.06;       // of a wave per centimetre towards the pylorus: Kwiatek 2006
constexpr double kMostShortening = 0.58;  // of the muscle: 58 % of the lumen at the pylorus, and no wave closes it
constexpr double kOnset = 10;             // in which the waves grow from none. Design choice [s]
// Distance from the crest at which (1 - x^2)^2 ends over its full width at half height.
constexpr double kSupport = 0.924;

double smooth(double x) {
  const double u = std::clamp(x, 0.0, 1.0);
  return u * u * (3 - 2 * u);
}

// Mean distance of the wall from each station of the axis [m].
std::vector<double> radiiOf(const StomachAxis& axis, const Organ& organ) {
  const auto& stations = axis.stations();
  std::vector<double> sum(stations.size(), 0), count(stations.size(), 0);
  for (std::size_t v = 0; v < organ.surface.vertices.size(); ++v) {
    if (organ.end[v] == End::Oesophagus) continue;
    const double length = axis.lengthAt(static_cast<int>(v));
    const auto nearest = std::min_element(stations.begin(), stations.end(), [&](const auto& a, const auto& b) {
      return std::abs(a.length - length) < std::abs(b.length - length);
    });
    const auto at = static_cast<std::size_t>(nearest - stations.begin());
    sum[at] += (organ.surface.vertices[v] - nearest->centre).norm(), ++count[at];
  }
  for (std::size_t i = 0; i < sum.size(); ++i) sum[i] = count[i] > 0 ? sum[i] / count[i] : i > 0 ? sum[i - 1] : 0;
  return sum;
}

double radiusAt(const StomachAxis& axis, const std::vector<double>& radii, double length) {
  const auto& stations = axis.stations();
  std::size_t after = 1;
  while (after + 1 < stations.size() && stations[after].length < length) ++after;
  const double from = stations[after - 1].length;
  const double part = std::clamp((length - from) / (stations[after].length - from), 0.0, 1.0);
  return (1 - part) * radii[after - 1] + part * radii[after];
}

}  // namespace

WallMuscle::WallMuscle(const MotionScene& scene, const Organ& organ) : period_(1 / scene.wave_rate) {
  if (std::find(organ.end.begin(), organ.end.end(), End::Duodenum) == organ.end.end())
    throw Error(
        "The section 'motion' needs an organ with an axis from fundus to pylorus, and this one has no end at the "
        "duodenum; remove the section, or load a stomach.");
  const StomachAxis axis = findAxis(organ);
  const std::vector<double> radii = radiiOf(axis, organ);
  const double start = kWaveStart * axis.length(), way = axis.length() - start;
  const double first = kStartSpeed * scene.wave_speed,
               gain = (scene.wave_speed - first) / std::max(way - kDistal, way / 2);
  std::vector<char> has(organ.surface.vertices.size(), 0);
  for (int v = 0; v < static_cast<int>(has.size()); ++v) {
    const double passed = axis.lengthAt(v) - start;
    const double speed = std::min(first + gain * passed, scene.wave_speed);
    if (!(passed > 0) || organ.end[v] == End::Oesophagus) continue;
    has[v] = 1;
    const double width = scene.wave_width * math::exp(-kNarrowing * 100 * (passed - way));
    const double grown = smooth(passed / ((kWaveGrown - kWaveStart) * axis.length()));
    const double depth = gradeOf(scene) * scene.wave_amplitude * grown;
    const double faster = (speed - first) / gain, arrival = math::log(speed / first) / gain + (passed - faster) / speed;
    nodes_.push_back({v, arrival, std::min(kSupport * width / speed, period_ / 2),
                      std::min(depth / radiusAt(axis, radii, axis.lengthAt(v)), kMostShortening)});
  }
  const std::vector<double> alike(organ.surface.triangles.size(), 1);
  const ShellFibres around = wallFibres({0, 1, kPi / 2}, organ, alike);
  for (std::size_t e = 0; e < alike.size(); ++e) {
    const auto& t = organ.surface.triangles[e];
    const bool muscle = has[t[0]] != 0 || has[t[1]] != 0 || has[t[2]] != 0;
    directions_.push_back(muscle ? around.direction[e][0] : Eigen::Vector3d(0, 0, 0));
  }
}

void WallMuscle::contraction(double time, float* out, std::size_t stride) const {
  const double onset = smooth(time / kOnset);
  for (const Node& node : nodes_) {
    const double waves = (time - node.arrival) / period_, x = (waves - std::round(waves)) * period_ / node.half;
    const double rest = std::max(0.0, 1 - x * x), shortening = onset * node.shortening * rest * rest;
    out[stride * static_cast<std::size_t>(node.number)] = static_cast<float>(1 / (1 - shortening) - 1);
  }
}

}  // namespace vibe
