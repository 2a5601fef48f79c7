#pragma once
#include <Eigen/Dense>

namespace vibe::vision {

/// Linear least squares with equal weights, its covariance and its leverages.
struct LinearFit {
  Eigen::VectorXd solution, residual;
  Eigen::VectorXd leverage;    ///< diagonal of the hat matrix
  Eigen::MatrixXd covariance;  ///< scaled by the residuals; zero without a degree of freedom
  int freedom = 0;

  /// Probability of a residual as large as that of `row` if the other rows are right (deleted Studentised residual);
  /// 1 where too few rows remain to tell.
  double deletedTail(Eigen::Index row) const;
};

LinearFit solveLinear(const Eigen::MatrixXd& a, const Eigen::VectorXd& b);

}  // namespace vibe::vision
