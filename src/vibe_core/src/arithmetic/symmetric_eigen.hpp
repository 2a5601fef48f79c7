#pragma once

#include <Eigen/Core>

namespace vibe {

/// Eigenvalues and eigenvectors of a symmetric 3 x 3 matrix, of which the lower triangle is read. The operations and
/// their order are written here, because those of Eigen's solver differ between its versions, and with them the last
/// bits of a step. Householder's reduction to tridiagonal form and the implicit QR iteration with Wilkinson's shift
/// (Golub and Van Loan, Matrix Computations, 8.3).
struct SymmetricEigen3 {
  explicit SymmetricEigen3(const Eigen::Matrix3d& symmetric);

  Eigen::Vector3d values;   ///< in ascending order
  Eigen::Matrix3d vectors;  ///< the columns, of length 1
};

}  // namespace vibe
