#include "builder/mesh_import.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

#include "arithmetic/elementary.hpp"
#include "arithmetic/turn.hpp"
#include "geometry/surface_check.hpp"
#include "scene/size_estimate.hpp"
#include "vibe_core/files/number_text.hpp"
#include "vibe_core/geometry/mesh_file.hpp"
#include "vibe_core/program/error.hpp"

namespace vibe {

namespace {

constexpr double kSmallestOrgan = 0.05;  // [m] largest side of the bounding box
constexpr double kLargestOrgan = 1.0;    // [m]
constexpr double kSamePlace = 1e-3;      // [m] between two landmarks
constexpr double kTypicalOrgan = 0.25;   // [m]

double largestSide(const SurfaceMesh& mesh) {
  Eigen::AlignedBox3d box;
  for (const auto& v : mesh.vertices) box.extend(v);
  return box.sizes().maxCoeff();
}

bool plausible(double size) {
  return size >= kSmallestOrgan && size <= kLargestOrgan;
}

std::string number(double value) {
  return formatted("%.4g", value);
}

/// The remedy for a wrong or missing unit: the one that gives the most likely size.
std::string unitAdvice(double size) {
  const auto unlikeliness = [&](const LengthUnit& unit) {
    return std::abs(math::log(size * unit.metres / kTypicalOrgan));
  };
  const auto& units = lengthUnits();
  const auto best = std::min_element(units.begin(), units.end(), [&](const LengthUnit& a, const LengthUnit& b) {
    return unlikeliness(a) < unlikeliness(b);
  });
  if (!plausible(size * best->metres))
    return "no usual unit makes that an organ of 0.05 to 1 m, so state its target_volume";
  return "state its unit, perhaps 'unit: 1 " + best->name + "', with which it is " + number(size * best->metres) +
         " m large";
}

/// Those that are stated: in the scene, else in the file.
std::array<double, 3> rotationOfFile(const GeometryScene& geometry) {
  const std::optional<PatientAxes> axes = statedAxes(geometry.file);
  return axes && geometry.rotation_rpy == std::array<double, 3>{0, 0, 0} ? rotationOf(*axes) : geometry.rotation_rpy;
}

/// Metres per unit of the file.
double findScale(const GeometryScene& geometry, const SurfaceMesh& mesh) {
  const double size = largestSide(mesh);
  if (geometry.target_volume > 0.0) {
    const double scale = math::cbrt(geometry.target_volume / enclosedVolume(mesh));
    if (plausible(size * scale)) return scale;
    throw Error("geometry.target_volume " + number(geometry.target_volume) + " m^3 makes " + geometry.file + " " +
                number(size * scale) + " m large; choose a volume that gives an organ of 0.05 to 1 m");
  }
  if (geometry.unit == 0.0 && !statesMetres(geometry.file)) {
    throw Error("geometry.unit is missing: " + geometry.file + " is " + number(size) +
                " units large and its format has no unit; " + unitAdvice(size));
  }
  const double unit = geometry.unit == 0.0 ? 1.0 : geometry.unit;
  if (unit > 0.0 && plausible(size * unit)) return unit;
  throw Error(geometry.file + " is " + number(size) + " units large, which with a unit of " + number(unit) + " m" +
              (geometry.unit == 0.0 ? ", as glTF prescribes," : "") + " is no organ of 0.05 to 1 m; " +
              unitAdvice(size));
}

void checkLandmarks(const GeometryScene& geometry) {
  std::string missing;
  const std::array<std::pair<const char*, bool>, 4> given{{{"oesophagus", geometry.oesophagus.has_value()},
                                                           {"fundus", geometry.fundus.has_value()},
                                                           {"incisura", geometry.incisura.has_value()},
                                                           {"pylorus", geometry.pylorus.has_value()}}};
  for (const auto& [name, present] : given) {
    if (!present) missing += (missing.empty() ? "geometry." : ", geometry.") + std::string(name);
  }
  if (missing.empty()) return;
  throw Error("landmarks of " + geometry.file + " are missing: " + missing +
              "; read them off in a mesh viewer as [x, y, z] in the frame and unit of the file");
}

/// Two names of one place are a mistake, and regions follow from them.
void checkApart(const Landmarks& landmarks, const std::string& file) {
  const std::array<std::pair<const char*, Eigen::Vector3d>, 4> named{{{"oesophagus", landmarks.oesophagus},
                                                                      {"fundus", landmarks.fundus},
                                                                      {"incisura", landmarks.incisura},
                                                                      {"pylorus", landmarks.pylorus}}};
  for (std::size_t a = 0; a < named.size(); ++a)
    for (std::size_t b = a + 1; b < named.size(); ++b) {
      const double distance = (named[a].second - named[b].second).norm();
      if (!(distance < kSamePlace)) continue;
      throw Error(file + ": The landmarks '" + named[a].first + "' and '" + named[b].first + "' are " +
                  number(distance * 1e3) + " mm apart, which is one place; state the place of each.");
    }
}

}  // namespace

ImportedMesh importMesh(const GeometryScene& geometry) {
  if (geometry.file.empty()) throw Error("geometry.file is missing; kind mesh needs the path of a mesh file");
  checkLandmarks(geometry);
  ImportedMesh result;
  result.surface = readMeshFile(geometry.file);
  checkSurface(result.surface, geometry.file);
  orientOutwards(result.surface);

  const Eigen::Matrix3d map =
      geometry.scale * findScale(geometry, result.surface) * rotationFromRpy(rotationOfFile(geometry));
  for (auto& v : result.surface.vertices) v = map * v;
  result.landmarks.oesophagus = map * *geometry.oesophagus;
  result.landmarks.fundus = map * *geometry.fundus;
  result.landmarks.incisura = map * *geometry.incisura;
  result.landmarks.pylorus = map * *geometry.pylorus;
  checkApart(result.landmarks, geometry.file);
  return result;
}

}  // namespace vibe
