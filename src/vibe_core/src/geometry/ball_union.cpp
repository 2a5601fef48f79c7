#include "geometry/ball_union.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "arithmetic/elementary.hpp"

namespace vibe {

namespace {

constexpr int kProjectionSteps = 8;
constexpr double kTolerance = 1e-8;    // [m]
constexpr double kNegligible = -36.0;  // exponent below the resolution of a double

}  // namespace

void BallUnion::add(const Eigen::Vector3d& centre, double radius, double spacing) {
  // the integral of exp(-sqrt(r^2 + s^2) / k) over the row is about exp(-r / k) sqrt(2 pi k r)
  balls_.push_back({centre, radius, spacing / std::sqrt(2.0 * M_PI * blend_ * radius)});
}

double BallUnion::evaluate(const Eigen::Vector3d& p, Eigen::Vector3d* gradient) const {
  // shift by the nearest ball, so that the exponentials neither overflow nor all underflow far away
  double shift = -1e300;
  for (const auto& ball : balls_) shift = std::max(shift, ball.radius - offset(p, ball).norm());
  double sum = 0.0;
  Eigen::Vector3d slope = Eigen::Vector3d::Zero();
  for (const auto& ball : balls_) {
    const Eigen::Vector3d d = offset(p, ball);
    const double distance = d.norm();
    const double exponent = (ball.radius - distance - shift) / blend_;
    if (exponent < kNegligible) continue;
    const double weight = ball.weight * math::exp(exponent);
    sum += weight;
    if (gradient && distance > 0.0) slope += weight / distance * d;
  }
  if (gradient) *gradient = Eigen::Vector3d(slope.x() / flattening_, slope.y(), slope.z()) / sum;
  return -shift - blend_ * math::log(sum);
}

Eigen::Vector3d BallUnion::offset(const Eigen::Vector3d& p, const Ball& ball) const {
  return {(p.x() - ball.centre.x()) / flattening_, p.y() - ball.centre.y(), p.z() - ball.centre.z()};
}

double BallUnion::value(const Eigen::Vector3d& p) const {
  return evaluate(p, nullptr);
}

Eigen::Vector3d BallUnion::project(const Eigen::Vector3d& p) const {
  Eigen::Vector3d x = p, gradient;
  for (int k = 0; k < kProjectionSteps; ++k) {
    const double f = evaluate(x, &gradient);
    if (std::abs(f) < kTolerance || gradient.squaredNorm() == 0.0) break;
    x -= f / gradient.squaredNorm() * gradient;
  }
  return x;
}

namespace {

// Kuhn's six tetrahedra around the diagonal of a cube; bit 0 of a corner is x, bit 1 is y, bit 2 is z
constexpr int kTetrahedra[6][4] = {{0, 1, 3, 7}, {0, 3, 2, 7}, {0, 2, 6, 7}, {0, 6, 4, 7}, {0, 4, 5, 7}, {0, 5, 1, 7}};

class Marcher {
 public:
  Marcher(const std::function<double(const Eigen::Vector3d&)>& field, const Eigen::AlignedBox3d& box, double cell)
      : corner_(box.min()), cell_(cell) {
    for (int k = 0; k < 3; ++k) size_[k] = static_cast<int>(std::ceil(box.sizes()[k] / cell)) + 1;
    values_.reserve(static_cast<std::size_t>(size_[0]) * size_[1] * size_[2]);
    for (int z = 0; z < size_[2]; ++z) {
      for (int y = 0; y < size_[1]; ++y) {
        for (int x = 0; x < size_[0]; ++x) values_.push_back(field(corner_ + cell_ * Eigen::Vector3d(x, y, z)));
      }
    }
  }

  SurfaceMesh march() {
    for (int z = 0; z + 1 < size_[2]; ++z) {
      for (int y = 0; y + 1 < size_[1]; ++y) {
        for (int x = 0; x + 1 < size_[0]; ++x) marchCube(x, y, z);
      }
    }
    return std::move(mesh_);
  }

 private:
  std::int64_t node(int x, int y, int z) const {
    return x + static_cast<std::int64_t>(size_[0]) * (y + static_cast<std::int64_t>(size_[1]) * z);
  }

  Eigen::Vector3d place(std::int64_t n) const {
    const std::int64_t x = n % size_[0], y = n / size_[0] % size_[1], z = n / size_[0] / size_[1];
    return corner_ + cell_ * Eigen::Vector3d(static_cast<double>(x), static_cast<double>(y), static_cast<double>(z));
  }

  bool inside(std::int64_t n) const { return values_[n] < 0.0; }

  void marchCube(int x, int y, int z) {
    std::array<std::int64_t, 8> corner;
    int count = 0;
    for (int k = 0; k < 8; ++k) {
      corner[k] = node(x + (k & 1), y + (k >> 1 & 1), z + (k >> 2));
      count += inside(corner[k]) ? 1 : 0;
    }
    if (count == 0 || count == 8) return;
    for (const auto& t : kTetrahedra) marchTetrahedron({corner[t[0]], corner[t[1]], corner[t[2]], corner[t[3]]});
  }

  void marchTetrahedron(const std::array<std::int64_t, 4>& n) {
    std::vector<std::int64_t> in, out;
    for (const auto k : n) (inside(k) ? in : out).push_back(k);
    if (in.empty() || out.empty()) return;
    const Eigen::Vector3d outward = mean(out) - mean(in);
    if (in.size() == 2) {
      const int a = crossing(in[0], out[0]), b = crossing(in[0], out[1]);
      const int c = crossing(in[1], out[1]), d = crossing(in[1], out[0]);
      addTriangle(a, b, c, outward);
      addTriangle(a, c, d, outward);
      return;
    }
    const auto& one = in.size() == 1 ? in : out;
    const auto& three = in.size() == 1 ? out : in;
    // one after another: the order numbers the vertices, and compilers evaluate arguments in different orders
    const int c = crossing(one[0], three[2]);
    const int b = crossing(one[0], three[1]);
    const int a = crossing(one[0], three[0]);
    addTriangle(a, b, c, outward);
  }

  Eigen::Vector3d mean(const std::vector<std::int64_t>& nodes) const {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (const auto n : nodes) sum += place(n);
    return sum / static_cast<double>(nodes.size());
  }

  /// Vertex on the edge between two nodes, shared by all tetrahedra at that edge.
  int crossing(std::int64_t a, std::int64_t b) {
    if (a > b) std::swap(a, b);
    const std::int64_t key = a * static_cast<std::int64_t>(values_.size()) + b;
    const auto [entry, is_new] = vertex_of_edge_.emplace(key, static_cast<int>(mesh_.vertices.size()));
    if (is_new) {
      // kept away from the nodes: several crossings there would coincide and form triangles without area
      const double t = std::clamp(values_[a] / (values_[a] - values_[b]), 0.05, 0.95);
      mesh_.vertices.emplace_back((1.0 - t) * place(a) + t * place(b));
    }
    return entry->second;
  }

  void addTriangle(int a, int b, int c, const Eigen::Vector3d& outward) {
    const Eigen::Vector3d& p = mesh_.vertices[a];
    const bool turned = (mesh_.vertices[b] - p).cross(mesh_.vertices[c] - p).dot(outward) < 0.0;
    mesh_.triangles.push_back(turned ? std::array<int, 3>{a, c, b} : std::array<int, 3>{a, b, c});
  }

  Eigen::Vector3d corner_;
  double cell_;
  std::array<int, 3> size_{};   ///< nodes per axis
  std::vector<double> values_;  ///< of the field at the nodes
  SurfaceMesh mesh_;
  std::unordered_map<std::int64_t, int> vertex_of_edge_;
};

}  // namespace

SurfaceMesh marchTetrahedra(const std::function<double(const Eigen::Vector3d&)>& field, const Eigen::AlignedBox3d& box,
                            double cell) {
  return Marcher(field, box, cell).march();
}

}  // namespace vibe
