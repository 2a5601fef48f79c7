#include "suture/technique_wall.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "common/constants.hpp"
#include "common/elementary.hpp"

namespace vibe {
namespace {

constexpr int kAxisSteps = 4;  // axes of candidate cylinders about 20 degrees apart
constexpr double kMaxWrap = 1.1 * kPi;

using Rows = Eigen::Matrix<double, Eigen::Dynamic, 3>;

/// Least-squares circle (Kasa 1976, IEEE Trans Instrum Meas 25:8) through the columns x, y; false if they are
/// collinear.
bool fitCircle(const Eigen::VectorXd& x, const Eigen::VectorXd& y, Eigen::Vector2d& centre, double& radius) {
  Eigen::Matrix<double, Eigen::Dynamic, 3> a(x.size(), 3);
  a << 2 * x, 2 * y, Eigen::VectorXd::Ones(x.size());
  const Eigen::VectorXd b = x.array().square() + y.array().square();
  const Eigen::Matrix3d normal = a.transpose() * a;
  const auto solver = normal.ldlt();
  const Eigen::Vector3d found = solver.solve(a.transpose() * b);
  centre = found.head<2>();
  radius = std::sqrt(found.z() + centre.squaredNorm());
  const double size = std::sqrt(b.sum() / static_cast<double>(x.size()));
  return std::isfinite(radius) && radius < 20 * size;
}

void centreBites(FlatBites& flat) {
  std::complex<double> centre = 0;
  for (const auto& p : flat.bites) centre += p / static_cast<double>(flat.bites.size());
  for (auto& p : flat.bites) p -= centre;
}

/// Unrolls the cylinder with this axis (a unit vector); false if the bites do not lie on one side of a cylinder.
bool unroll(const Rows& bites, const Eigen::Vector3d& axis, FlatBites& flat) {
  const Eigen::Vector3d e1 = axis.unitOrthogonal(), e2 = axis.cross(e1);
  const Eigen::VectorXd x = bites * e1, y = bites * e2, z = bites * axis;
  Eigen::Vector2d centre;
  double radius;
  if (!fitCircle(x, y, centre, radius)) return false;
  const double middle =
      math::atan2(-centre.y(), -centre.x());  // direction of the bites from the axis; bites are centred
  flat = {};
  double min = 0, max = 0;
  for (int k = 0; k < bites.rows(); ++k) {
    const double dx = x[k] - centre.x(), dy = y[k] - centre.y();
    const double angle = std::remainder(math::atan2(dy, dx) - middle, 2 * kPi);
    min = std::min(min, angle), max = std::max(max, angle);
    flat.bites.emplace_back(radius * angle, z[k]);
    const double off = math::hypot(dx, dy) - radius;
    flat.off_wall += off * off;
  }
  flat.wrap = max - min;
  centreBites(flat);
  return flat.wrap < kMaxWrap;
}

/// Directions over a hemisphere, symmetric with respect to each coordinate axis: a reflected set is laid flat on
/// reflected cylinders.
std::vector<Eigen::Vector3d> candidateAxes() {
  std::vector<Eigen::Vector3d> axes;
  for (int i = -kAxisSteps; i <= kAxisSteps; ++i)
    for (int j = -kAxisSteps; j <= kAxisSteps; ++j) {
      const int k = kAxisSteps - std::abs(i) - std::abs(j);
      if (k < 0) continue;
      const bool on_rim = k == 0 && (j < 0 || (j == 0 && i < 0));  // the opposite direction is already included
      if (!on_rim) axes.push_back(Eigen::Vector3d(i, j, k).normalized());
    }
  return axes;
}

}  // namespace

std::vector<FlatBites> layFlat(const std::vector<Eigen::Vector3d>& bites) {
  Rows rows(bites.size(), 3);
  for (std::size_t k = 0; k < bites.size(); ++k) rows.row(static_cast<Eigen::Index>(k)) = bites[k];
  rows.rowwise() -= rows.colwise().mean().eval();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> spread(rows.transpose() * rows);
  const Rows own = rows * spread.eigenvectors();  // smallest spread first

  FlatBites plane;
  plane.off_wall = own.col(0).squaredNorm();
  for (Eigen::Index k = 0; k < own.rows(); ++k) plane.bites.emplace_back(own(k, 2), own(k, 1));
  std::vector<FlatBites> result{plane};
  FlatBites rolled;
  for (const Eigen::Vector3d& axis : candidateAxes())
    if (unroll(own, axis, rolled)) result.push_back(rolled);
  return result;
}

}  // namespace vibe
