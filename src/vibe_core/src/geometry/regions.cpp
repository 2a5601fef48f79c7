#include "geometry/regions.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <string>

#include "geometry/surface_operators.hpp"
#include "vibe_core/program/error.hpp"

namespace vibe {

namespace {

constexpr double kCardiaReach = 20e-3;       // [m] around the junction
constexpr double kCardiaRadius = 26e-3;      // [m] around the oesophagus; excludes the way up the side of the fundus
constexpr double kPyloricCanal = 30e-3;      // [m] Loyola University radiology: the pyloric canal is 3 cm long
constexpr double kFundusPatch = 12e-3;       // [m] around the apex, where the axis begins
constexpr double kTransition = 10e-3;        // [m] of the thickness across region borders, standard deviation
constexpr double kFarthestLandmark = 40e-3;  // [m] from the surface: half of a large lumen

int nearestVertex(const SurfaceMesh& mesh, const Eigen::Vector3d& p) {
  int best = 0;
  for (int v = 1; v < static_cast<int>(mesh.vertices.size()); ++v) {
    if ((mesh.vertices[v] - p).squaredNorm() < (mesh.vertices[best] - p).squaredNorm()) best = v;
  }
  return best;
}

int landmarkVertex(const SurfaceMesh& mesh, const Eigen::Vector3d& p, const char* name) {
  const int v = nearestVertex(mesh, p);
  const double distance = (mesh.vertices[v] - p).norm();
  if (!(distance <= kFarthestLandmark)) {
    throw Error("The landmark '" + std::string(name) + "' is " +
                std::to_string(static_cast<int>(std::min(1e9, distance * 1e3))) +
                " mm away from the surface; state it in the axes and the unit of the surface file.");
  }
  return v;
}

std::vector<int> verticesOf(const Organ& organ, End end) {
  std::vector<int> list;
  for (int v = 0; v < static_cast<int>(organ.end.size()); ++v) {
    if (organ.end[v] == end) list.push_back(v);
  }
  return list;
}

std::vector<int> verticesWithin(const SurfaceMesh& mesh, int centre, double radius) {
  std::vector<int> list;
  for (int v = 0; v < static_cast<int>(mesh.vertices.size()); ++v) {
    if ((mesh.vertices[v] - mesh.vertices[centre]).norm() <= radius) list.push_back(v);
  }
  return list;
}

/// Distance from the line between the end and the junction.
double distanceToGullet(const Organ& organ, const Eigen::Vector3d& p) {
  const Eigen::Vector3d line = organ.landmarks.oesophagus - organ.entry, to_p = p - organ.entry;
  const double t = line.squaredNorm() > 0.0 ? std::clamp(to_p.dot(line) / line.squaredNorm(), 0.0, 1.0) : 0.0;
  return (to_p - t * line).norm();
}

/// Length of the oesophagus segment between the end and the junction.
double gulletLength(const Organ& organ) {
  return (organ.entry - organ.landmarks.oesophagus).norm();
}

}  // namespace

Wall wallAtAngle(double angle) {
  if (std::abs(angle) <= M_PI / 4) return Wall::Anterior;
  if (std::abs(angle) >= 3 * M_PI / 4) return Wall::Posterior;
  return angle > 0 ? Wall::GreaterCurvature : Wall::LesserCurvature;
}

double beginOfCanal(double incisura, double pylorus) {
  return pylorus - std::min(kPyloricCanal, 0.5 * (pylorus - incisura));
}

StomachAxis findAxis(const Organ& organ) {
  const int apex = landmarkVertex(organ.surface, organ.landmarks.fundus, "fundus");
  const auto from_gullet = edgeDistances(organ.surface, verticesOf(organ, End::Oesophagus));
  std::vector<bool> ignored(from_gullet.size());
  for (std::size_t v = 0; v < ignored.size(); ++v) ignored[v] = from_gullet[v] < gulletLength(organ);
  return StomachAxis(organ.surface, verticesWithin(organ.surface, apex, kFundusPatch), verticesOf(organ, End::Duodenum),
                     ignored, organ.landmarks.anterior);
}

void labelStomach(Organ& organ) {
  const SurfaceMesh& mesh = organ.surface;
  const StomachAxis axis = findAxis(organ);
  landmarkVertex(mesh, organ.landmarks.oesophagus, "oesophagus");
  const double incisura = axis.lengthAt(landmarkVertex(mesh, organ.landmarks.incisura, "incisura"));
  const double pylorus = axis.lengthAt(landmarkVertex(mesh, organ.landmarks.pylorus, "pylorus"));
  const double canal = beginOfCanal(incisura, pylorus);
  const auto from_gullet = edgeDistances(mesh, verticesOf(organ, End::Oesophagus));
  const double cardia = gulletLength(organ) + kCardiaReach;

  const int count = static_cast<int>(mesh.vertices.size());
  organ.region.assign(count, Region::Body);
  organ.wall.resize(count);
  for (int v = 0; v < count; ++v) {
    const double along = axis.lengthAt(v);
    if (from_gullet[v] < cardia && distanceToGullet(organ, mesh.vertices[v]) < kCardiaRadius) {
      organ.region[v] = Region::Cardia;
    } else if (along >= canal) {
      organ.region[v] = Region::Pylorus;
    } else if (along >= incisura) {
      organ.region[v] = Region::Antrum;
    } else if (mesh.vertices[v].z() > organ.landmarks.oesophagus.z()) {
      organ.region[v] = Region::Fundus;
    }
    organ.wall[v] = wallAtAngle(axis.angleAt(v));
  }
}

std::vector<double> thicknessFromRegions(const SurfaceMesh& mesh, const std::vector<Region>& region,
                                         const std::array<double, kRegionCount>& thickness) {
  std::vector<double> values;
  values.reserve(region.size());
  for (const Region r : region) values.push_back(thickness[static_cast<int>(r)]);
  return diffuse(mesh, values, kTransition);
}

}  // namespace vibe
