#pragma once

#include <Eigen/Core>

namespace vibe {

/// b becomes A^-1 b by P A = L U with the largest pivot of each column; A becomes L (below the diagonal) and U. A zero
/// pivot leaves numbers in b that are not finite. The operations and their order are written here, those of Eigen
/// 3.4.0, because that of its partialPivLu() differs between versions.
void solveByOrderedLu(Eigen::Ref<Eigen::MatrixXd> a, Eigen::Ref<Eigen::MatrixXd> b);

}  // namespace vibe
