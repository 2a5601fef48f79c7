#include "vibe_core/thermal/mark_zones.hpp"

#include <algorithm>

namespace vibe {

bool inWorkingZone(Region region, Wall wall) {
  return region == Region::Body && wall != Wall::LesserCurvature;
}

MarkFinder::MarkFinder(const Organ& organ)
    : organ_(organ),
      area_(vertexAreas(organ.surface)),
      neighbours_(vertexNeighbours(organ.surface)),
      seen_(organ.surface.vertices.size(), 0) {
  open_.reserve(seen_.size());
}

MarkZone MarkFinder::collect(int first, const ThermalDose& law, const std::vector<float>& dose,
                             const SurfaceView& wall) {
  MarkZone zone;
  zone.particle = first;
  zone.in_zone = true;
  open_.assign(1, first);
  seen_[first] = 1;
  for (std::size_t i = 0; i < open_.size(); ++i) {
    const int particle = open_[i];
    ++zone.count;
    zone.area += area_[particle];
    zone.centre += wall.position(particle);
    zone.in_zone = zone.in_zone && inWorkingZone(organ_.region[particle], organ_.wall[particle]);
    if (dose[particle] > dose[zone.particle]) zone.particle = particle;
    for (const int next : neighbours_[particle]) {
      if (seen_[next] != 0 || law.grade(dose[next]) == BurnGrade::None) continue;
      seen_[next] = 1;
      open_.push_back(next);
    }
  }
  zone.centre /= zone.count;
  zone.wall = organ_.wall[zone.particle];
  zone.region = organ_.region[zone.particle];
  zone.grade = law.grade(dose[zone.particle]);
  return zone;
}

void MarkFinder::measureWalls(const ThermalDose& law, const std::vector<float>& dose) {
  for (auto& list : marked_) list.clear();
  for (int p = 0; p < static_cast<int>(dose.size()); ++p) {
    if (law.grade(dose[p]) != BurnGrade::None && inWorkingZone(organ_.region[p], organ_.wall[p]))
      marked_[static_cast<int>(organ_.wall[p])].push_back(p);
  }
  for (int w = 0; w < kWallCount; ++w) {
    // the point farthest from any point, then the one farthest from that: the ends of a line, without trying all pairs
    double length = 0;
    if (!marked_[w].empty()) farthest(farthest(marked_[w].front(), marked_[w], length), marked_[w], length);
    walls_[w] = {static_cast<int>(marked_[w].size()), length};
  }
}

/// The particle of the list that is farthest from another one in the rest shape, and its distance.
int MarkFinder::farthest(int from, const std::vector<int>& list, double& distance) const {
  int best = from;
  distance = 0;
  for (const int p : list) {
    const double d = (organ_.surface.vertices[p] - organ_.surface.vertices[from]).norm();
    if (d > distance) best = p, distance = d;
  }
  return best;
}

const std::vector<MarkZone>& MarkFinder::find(const ThermalDose& law, const std::vector<float>& dose,
                                              const SurfaceView& wall) {
  zones_.clear();
  std::fill(seen_.begin(), seen_.end(), 0);
  for (int p = 0; p < static_cast<int>(dose.size()); ++p) {
    if (seen_[p] == 0 && law.grade(dose[p]) != BurnGrade::None) zones_.push_back(collect(p, law, dose, wall));
  }
  measureWalls(law, dose);
  return zones_;
}

}  // namespace vibe
