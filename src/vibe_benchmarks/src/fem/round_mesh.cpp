#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <string>

#include <Eigen/Geometry>

#include "fem/bench_mesh.hpp"
#include "vibe_core/program/error.hpp"

namespace vibe::benchmarks {
namespace {

const double kPi = std::acos(-1.0);
constexpr double kGrading = 0.25;  // growth of the sides of triangles per length away from a pole (ratio)
constexpr int kFewest = 5;         // nodes of a ring

/// The length of the meridian from one pole, in sides of triangles, at kFine + 1 equal steps of the angle eta.
/// @param edge  side of the triangles at an arc length from the nearer pole [m]
constexpr int kFine = 20000;
std::vector<double> meridian(const Eigen::Vector2d& axes, const std::function<double(double)>& edge) {
  std::vector<double> arc(kFine + 1, 0.0), sides(kFine + 1, 0.0);
  const auto speed = [&](int i) {
    const double eta = kPi * (i - 0.5) / kFine;
    return std::hypot(axes[0] * std::cos(eta), axes[1] * std::sin(eta)) * kPi / kFine;
  };
  for (int i = 1; i <= kFine; ++i) arc[i] = arc[i - 1] + speed(i);
  for (int i = 1; i <= kFine; ++i) {
    const double middle = 0.5 * (arc[i - 1] + arc[i]);
    sides[i] = sides[i - 1] + speed(i) / edge(std::min(middle, arc[kFine] - middle));
  }
  return sides;
}

/// eta (from one pole to the other) at equal steps of a length along the meridian.
std::vector<double> equalSteps(const std::vector<double>& length, int rings) {
  std::vector<double> eta;
  for (int r = 0, i = 0; r < rings; ++r) {
    const double wanted = length[kFine] * (r + 1) / (rings + 1);
    while (length[i + 1] < wanted) ++i;
    eta.push_back(kPi * (i + (wanted - length[i]) / (length[i + 1] - length[i])) / kFine);
  }
  return eta;
}

/// Number of nodes of each ring, proportional to its circumference, that add up to `nodes`.
std::vector<int> ringCounts(const std::vector<double>& circumference, int nodes) {
  const double total = std::accumulate(circumference.begin(), circumference.end(), 0.0);
  std::vector<int> count;
  for (const double c : circumference)
    count.push_back(std::max(kFewest, static_cast<int>(std::lround(c / total * nodes))));
  int missing = nodes - std::accumulate(count.begin(), count.end(), 0);
  // the longest rings are the least sensitive to one node more or less
  std::vector<int> order(count.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return circumference[a] > circumference[b]; });
  for (std::size_t k = 0; missing != 0; k = (k + 1) % order.size()) {
    if (missing < 0 && count[order[k]] <= kFewest) continue;
    count[order[k]] += missing > 0 ? 1 : -1;
    missing += missing > 0 ? -1 : 1;
  }
  return count;
}

/// Triangles between two rings of consecutive nodes; each step takes the shorter of the two possible sides.
void stitch(int first, int first_count, int second, int second_count, BenchMesh& mesh) {
  const auto a = [&](int i) { return first + i % first_count; };
  const auto b = [&](int i) { return second + i % second_count; };
  int start = 0;  // the node of the second ring nearest to the first node of the first ring
  for (int j = 1; j < second_count; ++j) {
    if ((mesh.nodes[b(j)] - mesh.nodes[a(0)]).norm() < (mesh.nodes[b(start)] - mesh.nodes[a(0)]).norm()) start = j;
  }
  for (int i = 0, j = 0; i < first_count || j < second_count;) {
    const double along = (mesh.nodes[a(i + 1)] - mesh.nodes[b(start + j)]).norm();
    const double across = (mesh.nodes[a(i)] - mesh.nodes[b(start + j + 1)]).norm();
    if (j == second_count || (i < first_count && along < across)) {
      mesh.triangles.push_back({a(i), b(start + j), a(i + 1)});
      ++i;
    } else {
      mesh.triangles.push_back({a(i), b(start + j), b(start + j + 1)});
      ++j;
    }
  }
}

void addRing(double radius, double z, int count, bool shifted, BenchMesh& mesh) {
  for (int i = 0; i < count; ++i) {
    const double angle = 2 * kPi * (i + (shifted ? 0.5 : 0.0)) / count;
    mesh.nodes.emplace_back(radius * std::cos(angle), radius * std::sin(angle), z);
  }
}

/// Closes rings of nodes on an ellipsoid of revolution to a surface.
/// @param axes  semi-axes across and along z [m]
BenchMesh closeRings(const Eigen::Vector2d& axes, const std::vector<double>& eta, const std::vector<int>& count) {
  BenchMesh mesh;
  mesh.nodes.emplace_back(0, 0, axes[1]);
  std::vector<int> first;
  for (std::size_t r = 0; r < eta.size(); ++r) {
    first.push_back(static_cast<int>(mesh.nodes.size()));
    addRing(axes[0] * std::sin(eta[r]), axes[1] * std::cos(eta[r]), count[r], r % 2 == 1, mesh);
  }
  mesh.nodes.emplace_back(0, 0, -axes[1]);
  const int last = static_cast<int>(mesh.nodes.size()) - 1;
  for (int i = 0; i < count[0]; ++i) mesh.triangles.push_back({0, first[0] + i, first[0] + (i + 1) % count[0]});
  for (std::size_t r = 0; r + 1 < eta.size(); ++r) stitch(first[r], count[r], first[r + 1], count[r + 1], mesh);
  const int end = first.back(), end_count = count.back();
  for (int i = 0; i < end_count; ++i) mesh.triangles.push_back({end + i, last, end + (i + 1) % end_count});
  return mesh;
}

void checkAxes(double radius, double half_length) {
  if (!(radius > 0) || !(half_length > 0))
    throw Error("mesh.ellipsoid: a semi-axis is not positive; give both in metres.");
}

}  // namespace

BenchMesh makeEllipsoid(double radius, double half_length, int nodes) {
  if (nodes < 14) throw Error("mesh.ellipsoid.nodes: " + std::to_string(nodes) + " is too few; give at least 14.");
  checkAxes(radius, half_length);
  // edge length of equilateral triangles on the surface: area / nodes = edge^2 sqrt(3)/2
  double area = 0;
  for (int i = 0; i < 2000; ++i) {
    const double eta = kPi * (i + 0.5) / 2000;
    area +=
        2 * kPi * radius * std::sin(eta) * std::hypot(radius * std::cos(eta), half_length * std::sin(eta)) * kPi / 2000;
  }
  const double edge = std::sqrt(area / nodes / std::sqrt(0.75));
  const auto length = meridian({radius, half_length}, [](double) { return 1.0; });
  const int wanted_rings = static_cast<int>(std::lround(length.back() / (edge * std::sqrt(0.75)))) - 1;
  const int rings = std::clamp(wanted_rings, 2, (nodes - 2) / kFewest);
  const auto eta = equalSteps(length, rings);
  std::vector<double> circumference;
  for (const double e : eta) circumference.push_back(2 * kPi * radius * std::sin(e));
  return closeRings({radius, half_length}, eta, ringCounts(circumference, nodes - 2));
}

BenchMesh makeGradedEllipsoid(double radius, double half_length, double edge, double pole_edge) {
  checkAxes(radius, half_length);
  if (!(pole_edge > 0) || !(edge >= pole_edge))
    throw Error("mesh.ellipsoid: 'pole_edge' is not between 0 and 'edge'; give the shorter side at the poles.");
  const auto side = [&](double from_pole) { return std::min(edge, pole_edge + kGrading * from_pole); };
  const auto sides = meridian({radius, half_length}, side);
  const int rings = std::max(2, static_cast<int>(std::lround(sides.back() / std::sqrt(0.75))) - 1);
  const auto eta = equalSteps(sides, rings);
  const auto length = meridian({radius, half_length}, [](double) { return 1.0; });
  std::vector<int> count;
  for (const double e : eta) {
    const double arc = length[static_cast<std::size_t>(e / kPi * kFine)];
    const double here = side(std::min(arc, length.back() - arc));
    count.push_back(std::max(kFewest, static_cast<int>(std::lround(2 * kPi * radius * std::sin(e) / here))));
  }
  return closeRings({radius, half_length}, eta, count);
}

namespace {

/// A disc about z of rings of 6, 12, 18, ... nodes; triangles counter-clockwise seen from above.
BenchMesh makeDisc(double radius, int rings) {
  BenchMesh disc;
  disc.nodes.emplace_back(0, 0, 0);
  for (int i = 0; i < 6; ++i) disc.triangles.push_back({0, 1 + i, 1 + (i + 1) % 6});
  int first = 1;
  for (int r = 1; r <= rings; first += 6 * r++) {
    addRing(radius * r / rings, 0, 6 * r, r % 2 == 1, disc);
    if (r > 1) stitch(first - 6 * (r - 1), 6 * (r - 1), first, 6 * r, disc);
  }
  for (auto& t : disc.triangles) {
    const Eigen::Vector3d u = disc.nodes[t[1]] - disc.nodes[t[0]], v = disc.nodes[t[2]] - disc.nodes[t[0]];
    if (u.cross(v).z() < 0) std::swap(t[1], t[2]);
  }
  return disc;
}

}  // namespace

BenchMesh makeCylinder(double radius, double height, int rings, int layers) {
  if (!(radius > 0) || !(height > 0) || rings < 1 || layers < 1)
    throw Error("mesh.cylinder: a length or a number of rings or layers is not positive; give all above 0.");
  const BenchMesh disc = makeDisc(radius, rings);
  const int per_layer = static_cast<int>(disc.nodes.size());
  BenchMesh mesh;
  for (int k = 0; k <= layers; ++k)
    for (int n = 0; n < per_layer; ++n) {
      if (k == 0) mesh.sets["z_min"].push_back(static_cast<int>(mesh.nodes.size()));
      if (k == layers) mesh.sets["z_max"].push_back(static_cast<int>(mesh.nodes.size()));
      mesh.nodes.push_back(disc.nodes[n] + Eigen::Vector3d(0, 0, height * k / layers));
    }
  // a prism is cut from its corner of the lowest number, so that neighbours agree on the diagonals (Dompierre 1999)
  for (int k = 0; k < layers; ++k)
    for (std::array<int, 3> t : disc.triangles) {
      std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
      const int a = t[0] + k * per_layer, b = t[1] + k * per_layer, c = t[2] + k * per_layer, up = per_layer;
      mesh.tets.push_back({a, b + up, c + up, a + up});
      if (b < c) {
        mesh.tets.push_back({a, b, c + up, b + up});
        mesh.tets.push_back({a, b, c, c + up});
      } else {
        mesh.tets.push_back({a, b, c, b + up});
        mesh.tets.push_back({a, b + up, c, c + up});
      }
    }
  for (auto& t : mesh.tets) {  // nodes 0 1 2 are counter-clockwise seen from node 3
    const Eigen::Vector3d &o = mesh.nodes[t[0]], u = mesh.nodes[t[1]] - o, v = mesh.nodes[t[2]] - o;
    if (u.cross(v).dot(mesh.nodes[t[3]] - o) < 0) std::swap(t[1], t[2]);
  }
  return mesh;
}

}  // namespace vibe::benchmarks
