#include "builder/mesh_import.hpp"

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <cstdio>
#include <string>
#include <utility>

#include "common/elementary.hpp"
#include "common/turn.hpp"
#include "geometry/surface_check.hpp"
#include "vibe_core/common/error.hpp"
#include "vibe_core/geometry/mesh_file.hpp"

namespace vibe {

namespace {

constexpr double kSmallestOrgan = 0.05;  // [m] largest side of the bounding box
constexpr double kLargestOrgan = 1.0;    // [m]
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
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", value);
  return text;
}

/// The remedy for a wrong or missing unit: the usual one that gives the most likely size.
std::string unitAdvice(double size) {
  double best = 0.0;
  for (const double unit : {1.0, 0.01, 0.001, 0.0254}) {
    if (!plausible(size * unit)) continue;
    if (best == 0.0 ||
        std::abs(math::log(size * unit / kTypicalOrgan)) < std::abs(math::log(size * best / kTypicalOrgan)))
      best = unit;
  }
  if (best == 0.0) return "no usual unit makes that an organ of 0.05 to 1 m, so give geometry.target_volume";
  return "give geometry.unit in metres per unit of the file, probably " + number(best) + " (" + number(size * best) +
         " m)";
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
  throw Error(geometry.file + " is " + number(size) + " units large, which with geometry.unit " + number(unit) +
              (geometry.unit == 0.0 ? " (metres, as glTF prescribes)" : "") + " is no organ of 0.05 to 1 m; " +
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

}  // namespace

ImportedMesh importMesh(const GeometryScene& geometry) {
  if (geometry.file.empty()) throw Error("geometry.file is missing; kind mesh needs the path of a mesh file");
  checkLandmarks(geometry);
  ImportedMesh result;
  result.surface = readMeshFile(geometry.file);
  checkSurface(result.surface, geometry.file);
  orientOutwards(result.surface);

  const Eigen::Matrix3d map =
      geometry.scale * findScale(geometry, result.surface) * rotationFromRpy(geometry.rotation_rpy);
  for (auto& v : result.surface.vertices) v = map * v;
  result.landmarks.oesophagus = map * *geometry.oesophagus;
  result.landmarks.fundus = map * *geometry.fundus;
  result.landmarks.incisura = map * *geometry.incisura;
  result.landmarks.pylorus = map * *geometry.pylorus;
  return result;
}

}  // namespace vibe
