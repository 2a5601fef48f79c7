#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include "tissue/shell_point.hpp"
#include "vibe_core/program/error.hpp"
#include "vibe_core/tissue/shell.hpp"

// Rest data of a shell: the neighbours of each side, and the rows of shell_kernel.hpp.

namespace vibe {
namespace {

using PatchMatrix = Eigen::Matrix<double, 3, 6>;

// Minimum in-plane fraction of a direction; below it the direction is undefined.
constexpr double kFibreMin = 1e-3;

std::string triangleName(std::size_t triangle) {
  return "triangle " + std::to_string(triangle) + " (counted from 0)";
}

std::string sideName(int from, int to) {
  return "the side of nodes " + std::to_string(from) + " and " + std::to_string(to);
}

// T with T^T A T = 1 for the metric of two tangents, upper triangular: 11, 12, 22.
std::array<double, 3> orthonormal(const Eigen::Vector3d& first, const Eigen::Vector3d& second) {
  const double length = first.norm(), along = first.dot(second) / (length * length);
  const double across = (second - along * first).norm();
  return {1 / length, -along / across, 1 / across};
}

struct Side {
  std::size_t triangle;
  int number;
};

}  // namespace

void ShellElements::checkMesh() const {
  const int nodes = nodeCount(), materials = static_cast<int>(mesh_.materials.size());
  const auto expectCount = [](std::size_t count, std::size_t wanted, const char* what) {
    if (count != wanted)
      throw Error("The shell has " + std::to_string(count) + " " + what + ", but needs " + std::to_string(wanted) +
                  ": give one each.");
  };
  expectCount(mesh_.thickness.size(), mesh_.triangles.size(), "thicknesses of triangles");
  if (!mesh_.material.empty()) expectCount(mesh_.material.size(), mesh_.triangles.size(), "materials of triangles");
  if (!mesh_.fixed.empty()) expectCount(mesh_.fixed.size(), mesh_.nodes.size(), "marks of fixed nodes");
  checkFibres();
  if (!mesh_.muscle.empty()) expectCount(mesh_.muscle.size(), mesh_.triangles.size(), "directions of muscle");
  for (std::size_t e = 0; e < mesh_.triangles.size(); ++e) {
    for (const int node : mesh_.triangles[e])
      if (node < 0 || node >= nodes)
        throw Error(triangleName(e) + " has node " + std::to_string(node) + ", but the mesh has the nodes 0 to " +
                    std::to_string(nodes - 1) + ": correct the triangle or add the node.");
    if (materialOf(e) < 0 || materialOf(e) >= materials)
      throw Error(triangleName(e) + " is of material " + std::to_string(materialOf(e)) + ", but there are " +
                  std::to_string(materials) + " materials: correct the number or add the material.");
    if (!(mesh_.thickness[e] > 0) || !std::isfinite(mesh_.thickness[e]))
      throw Error(triangleName(e) + " has a thickness of " + std::to_string(mesh_.thickness[e]) +
                  " m, but needs a finite number above 0: correct the thickness.");
    if (!(areaOf(e) > 0) || !std::isfinite(areaOf(e)))
      throw Error(triangleName(e) + " has no area at rest: repair the mesh.");
  }
}

void ShellElements::checkFibres() const {
  const ShellFibres& fibres = mesh_.fibres;
  if (fibres.modulus.empty()) return;
  if (fibres.modulus.size() != mesh_.triangles.size() || fibres.direction.size() != mesh_.triangles.size())
    throw Error("The fibres of the shell have " + std::to_string(fibres.modulus.size()) + " moduli and " +
                std::to_string(fibres.direction.size()) + " pairs of directions for " +
                std::to_string(mesh_.triangles.size()) + " triangles: give one each.");
  if (!(fibres.stiffening > 0) || !std::isfinite(fibres.stiffening))
    throw Error("The fibres of the shell have a stiffening of " + std::to_string(fibres.stiffening) +
                ", but need a finite number above 0: correct it.");
  for (std::size_t e = 0; e < mesh_.triangles.size(); ++e)
    if (!(fibres.modulus[e] >= 0) || !std::isfinite(fibres.modulus[e]) || !fibres.direction[e][0].allFinite() ||
        !fibres.direction[e][1].allFinite())
      throw Error(triangleName(e) + " has fibres of " + std::to_string(fibres.modulus[e]) +
                  " Pa, but needs 0 or more, and finite directions: correct them.");
}

void ShellElements::findNeighbours() {
  std::map<std::pair<int, int>, Side> sides;  // by the nodes in the order of the triangle
  for (std::size_t e = 0; e < mesh_.triangles.size(); ++e)
    for (int k = 0; k < 3; ++k) {
      const auto& t = mesh_.triangles[e];
      const int from = t[static_cast<std::size_t>((k + 1) % 3)], to = t[static_cast<std::size_t>((k + 2) % 3)];
      const auto [other, is_new] = sides.insert({{from, to}, Side{e, k}});
      if (!is_new)
        throw Error(triangleName(e) + " runs along " + sideName(from, to) + " in the same direction as triangle " +
                    std::to_string(other->second.triangle) +
                    ": turn one of them over, or give the side to two triangles only.");
    }
  patch_nodes_.assign(6 * mesh_.triangles.size(), -1);
  released_.assign(3 * mesh_.triangles.size(), 0);
  for (const auto& [nodes, side] : sides) {
    const auto& t = mesh_.triangles[side.triangle];
    std::copy(t.begin(), t.end(), patch_nodes_.begin() + static_cast<std::ptrdiff_t>(6 * side.triangle));
    const auto beyond = sides.find({nodes.second, nodes.first});
    if (beyond == sides.end() || rigid(side.triangle) != rigid(beyond->second.triangle)) continue;
    const auto& other = mesh_.triangles[beyond->second.triangle];
    patch_nodes_[6 * side.triangle + 3 + static_cast<std::size_t>(side.number)] =
        other[static_cast<std::size_t>(beyond->second.number)];
  }
  for (const auto& hinge : mesh_.hinged) {
    int found = 0;
    for (const auto& key : {std::make_pair(hinge[0], hinge[1]), std::make_pair(hinge[1], hinge[0])}) {
      const auto side = sides.find(key);
      if (side == sides.end()) continue;
      const std::size_t e = side->second.triangle, k = static_cast<std::size_t>(side->second.number);
      patch_nodes_[6 * e + 3 + k] = -1;
      released_[3 * e + k] = 1;
      ++found;
    }
    if (found == 0)
      throw Error(sideName(hinge[0], hinge[1]) + " is to be hinged, but no triangle has it: correct the nodes.");
  }
}

PatchMatrix ShellElements::restPatch(std::size_t triangle) const {
  PatchMatrix x;
  for (int k = 0; k < 6; ++k) {
    const int node = patchNode(triangle, k);
    if (node >= 0) {
      x.col(k) = mesh_.nodes[static_cast<std::size_t>(node)];
    } else {
      const int* beside = kBeside[k - 3];
      x.col(k) = x.col(beside[0]) + x.col(beside[1]) - x.col(k - 3);
    }
  }
  return x;
}

double ShellElements::areaOf(std::size_t triangle) const {
  const auto& t = mesh_.triangles[triangle];
  const Eigen::Vector3d& a = mesh_.nodes[static_cast<std::size_t>(t[0])];
  const Eigen::Vector3d b = mesh_.nodes[static_cast<std::size_t>(t[1])] - a;
  return b.cross(mesh_.nodes[static_cast<std::size_t>(t[2])] - a).norm() / 2;
}

void ShellElements::measure() {
  rest_.assign(mesh_.triangles.size() * kShellMuscleRows, 0.0);
  rest_area_.assign(mesh_.nodes.size(), 0.0);
  for (std::size_t e = 0; e < mesh_.triangles.size(); ++e) {
    for (const int node : mesh_.triangles[e]) rest_area_[static_cast<std::size_t>(node)] += areaOf(e);
    double* rest = rest_.data() + e * kShellMuscleRows;
    const PatchMatrix patch = restPatch(e);
    for (int k = 0; k < 5; ++k)
      Eigen::Map<Eigen::Vector3d>(rest + kShellPatch + 3 * k) = patch.col(k + 1) - patch.col(0);
    Eigen::Map<Eigen::Vector3d>(rest + kShellOrigin) = patch.col(0) - origin_;
    measureSides(e, patch, rest);
    measureBending(e, patch, rest);
    measureGhosts(e, rest);
  }
}

void ShellElements::measureSides(std::size_t triangle, const PatchMatrix& x, double* rest) const {
  const Eigen::Vector3d sides[3] = {x.col(2) - x.col(1), x.col(2) - x.col(0), x.col(1) - x.col(0)};
  const Eigen::Vector3d apexes[3] = {x.col(3) - x.col(0), x.col(1) - x.col(4), x.col(2) - x.col(5)};
  for (int k = 0; k < 3; ++k) {
    const double area = sides[k].cross(apexes[k]).norm() / 4;
    if (!(area > 1e-3 * areaOf(triangle)))
      throw Error(triangleName(triangle) + " is folded upon its neighbour beyond node " +
                  std::to_string(patchNode(triangle, k)) + ": smooth the mesh there or hinge the side between them.");
    const auto t = orthonormal(sides[k], apexes[k]);
    double* row = rest + kShellSide + 4 * k;
    std::copy(t.begin(), t.end(), row);
    row[3] = 2 * mesh_.thickness[triangle] * area / 3;
  }
}

void ShellElements::measureBending(std::size_t triangle, const PatchMatrix& x, double* rest) const {
  const Eigen::Vector3d first = 4 * (x.col(1) - x.col(0)) + x.col(3) - x.col(4);
  const Eigen::Vector3d second = 4 * (x.col(2) - x.col(0)) + x.col(3) - x.col(5);
  const Eigen::Vector3d area = first.cross(second);
  const double length = area.norm() * std::sqrt(1 + kShellSoftness);
  if (!(area.norm() > 1e-3 * 72 * areaOf(triangle)))
    throw Error(triangleName(triangle) + " has neighbours folded upon it: smooth the mesh there.");
  Eigen::Map<Eigen::Vector3d>(rest + kShellNormal) = area / length;
  rest[kShellLength] = length;
  const Material& m = mesh_.materials[static_cast<std::size_t>(materialOf(triangle))];
  const double t = mesh_.thickness[triangle];
  const double stiffness =
      areaOf(triangle) * t * t * t / 24 * m.young_modulus / (1 - m.poisson_ratio * m.poisson_ratio);
  rest[kShellBend] = stiffness * 36 * 36 / (length * length * length * length);
}

void ShellElements::measureFibres() {
  if (mesh_.fibres.modulus.empty()) return;
  fibre_rest_.assign(mesh_.triangles.size() * kFibreRows, 0.0);
  for (std::size_t e = 0; e < mesh_.triangles.size(); ++e) {
    double* rows = fibre_rest_.data() + kFibreRows * e;
    rows[kFibreModulus] = mesh_.fibres.modulus[e];
    for (int family = 0; family < 2; ++family) {
      const auto along = inSides(e, mesh_.fibres.direction[e][static_cast<std::size_t>(family)]);
      for (int side = 0; side < 3; ++side)
        Eigen::Map<Eigen::Vector2d>(rows + kFibreSide + 4 * side + 2 * family) = along[static_cast<std::size_t>(side)];
    }
  }
}

// A direction in the plane of a triangle, in the basis of each side's T; unit vectors, or 0 where it is across.
std::array<Eigen::Vector2d, 3> ShellElements::inSides(std::size_t triangle, const Eigen::Vector3d& along) const {
  const PatchMatrix x = restPatch(triangle);
  const Eigen::Vector3d sides[3] = {x.col(2) - x.col(1), x.col(2) - x.col(0), x.col(1) - x.col(0)};
  const Eigen::Vector3d apexes[3] = {x.col(3) - x.col(0), x.col(1) - x.col(4), x.col(2) - x.col(5)};
  const Eigen::Vector3d normal = sides[2].cross(sides[1]).normalized();
  const Eigen::Vector3d inside = along - along.dot(normal) * normal;
  std::array<Eigen::Vector2d, 3> out;
  for (int side = 0; side < 3; ++side) {
    const double* t = rest(triangle) + kShellSide + 4 * side;
    const Eigen::Vector3d first = t[0] * sides[side], second = t[1] * sides[side] + t[2] * apexes[side];
    Eigen::Vector2d& row = out[static_cast<std::size_t>(side)];
    row = Eigen::Vector2d(first.dot(inside), second.dot(inside));
    if (inside.norm() > kFibreMin * along.norm())
      row.normalize();
    else
      row.setZero();
  }
  return out;
}

void ShellElements::measureMuscle() {
  for (std::size_t e = 0; e < mesh_.triangles.size(); ++e) {
    if (!hasMuscle(e)) continue;
    const auto along = inSides(e, mesh_.muscle[e]);
    for (std::size_t side = 0; side < 3; ++side)
      Eigen::Map<Eigen::Vector2d>(rest_.data() + kShellMuscleRows * e + kShellMuscle + 2 * side) = along[side];
  }
}

void ShellElements::measureGhosts(std::size_t triangle, double* rest) const {
  const Eigen::Map<const Eigen::Vector3d> second(rest + kShellPatch), third(rest + kShellPatch + 3);
  const Eigen::Vector3d normal = second.cross(third).normalized();
  for (int k = 0; k < 3; ++k) {
    double* row = rest + kShellGhost + 4 * k;
    row[0] = patchNode(triangle, 3 + k) >= 0 ? 1 : 0;
    const bool clamped = row[0] == 0 && held(patchNode(triangle, kBeside[k][0])) &&
                         held(patchNode(triangle, kBeside[k][1])) &&
                         released_[3 * triangle + static_cast<std::size_t>(k)] == 0;
    Eigen::Map<Eigen::Vector3d>(row + 1) = clamped ? Eigen::Vector3d(std::sqrt(2.0) * normal) : Eigen::Vector3d::Zero();
  }
}

bool ShellElements::atBoundary(std::size_t triangle) const {
  return patchNode(triangle, 3) < 0 || patchNode(triangle, 4) < 0 || patchNode(triangle, 5) < 0;
}

}  // namespace vibe
