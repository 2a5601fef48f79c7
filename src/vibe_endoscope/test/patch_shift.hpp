#pragma once
#include <Eigen/Dense>
#include <optional>

namespace vibe::endoscope::test {

/// Levels of an image, row y and column x; not a number where it has none.
using Levels = Eigen::MatrixXd;

/// Side of a square patch and farthest shift that is tried [px].
constexpr int kPatch = 25, kSearch = 10;

/// Levels around a pixel without their mean and slope, so that light that brightens or fades across the patch does not
/// count, of norm 1. Empty where a level is missing or where there is no texture.
/// @param texture  least standard deviation of the levels [levels]
inline Levels patchAt(const Levels& image, int x, int y, double texture) {
  constexpr int kHalf = kPatch / 2;
  if (x < kHalf || y < kHalf || x + kHalf >= image.cols() || y + kHalf >= image.rows()) return {};
  Levels levels = image.block(y - kHalf, x - kHalf, kPatch, kPatch);
  if (!levels.allFinite()) return {};
  const Eigen::VectorXd place = Eigen::VectorXd::LinSpaced(kPatch, -kHalf, kHalf);
  const double scale = kPatch * place.squaredNorm();
  const Eigen::RowVectorXd across = (levels * place).sum() / scale * place.transpose();
  const Eigen::VectorXd down = (levels.transpose() * place).sum() / scale * place;
  levels.array() -= levels.mean();
  levels.rowwise() -= across;
  levels.colwise() -= down;
  const double norm = levels.norm();
  if (norm < texture * kPatch) return {};
  return levels / norm;
}

/// What patchShift() accepts.
struct PatchLimits {
  double texture = 2;   ///< least standard deviation of the levels [levels]
  double alike = 0.75;  ///< least correlation
  double sharp = 0.02;  ///< least curvature of the peak in any direction: along a lone edge there is none [1/px^2]
};

/// How far `now` has to be shifted to look like `before` around a pixel: the peak of the normalised cross-correlation,
/// refined by the paraboloid through its neighbours [px]. Nothing where the limits are not met.
inline std::optional<Eigen::Vector2d> patchShift(const Levels& before, const Levels& now, int column, int row,
                                                 const PatchLimits& limits = {}) {
  const Levels wanted = patchAt(before, column, row, limits.texture);
  if (wanted.size() == 0) return std::nullopt;
  constexpr int kSize = 2 * kSearch + 1;
  Eigen::MatrixXd found = Eigen::MatrixXd::Constant(kSize, kSize, -1);  // row: x, column: y
  for (int x = 0; x < kSize; ++x)
    for (int y = 0; y < kSize; ++y) {
      const Levels patch = patchAt(now, column + x - kSearch, row + y - kSearch, 0);
      if (patch.size() > 0) found(x, y) = wanted.cwiseProduct(patch).sum();
    }
  Eigen::Index x = 0, y = 0;
  if (found.maxCoeff(&x, &y) < limits.alike) return std::nullopt;
  if (x == 0 || y == 0 || x + 1 == kSize || y + 1 == kSize) return std::nullopt;  // the peak is farther away
  const Eigen::Matrix3d near = found.block<3, 3>(x - 1, y - 1);
  const Eigen::Vector2d slope(0.5 * (near(2, 1) - near(0, 1)), 0.5 * (near(1, 2) - near(1, 0)));
  Eigen::Matrix2d bend;
  bend(0, 0) = near(2, 1) - 2 * near(1, 1) + near(0, 1);
  bend(1, 1) = near(1, 2) - 2 * near(1, 1) + near(1, 0);
  bend(0, 1) = bend(1, 0) = 0.25 * (near(2, 2) - near(2, 0) - near(0, 2) + near(0, 0));
  if (Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(bend).eigenvalues().maxCoeff() > -limits.sharp)
    return std::nullopt;
  return Eigen::Vector2d(x - kSearch, y - kSearch) - bend.inverse() * slope;
}

}  // namespace vibe::endoscope::test
