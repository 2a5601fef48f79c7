#pragma once

#include <Eigen/SparseCore>
#include <vector>

#include "vibe_core/sparse/block_matrix.hpp"

namespace vibe::test {

/// A block matrix for other solvers, both triangles (3 * nodes x 3 * nodes).
inline Eigen::SparseMatrix<double> eigenMatrix(const BlockMatrix& matrix) {
  std::vector<Eigen::Triplet<double>> entries;
  const auto put = [&](int row, int column, const Eigen::Matrix3d& block) {
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) entries.emplace_back(3 * row + i, 3 * column + j, block(i, j));
  };
  const BlockPattern& pattern = matrix.pattern();
  for (int i = 0; i < pattern.size; ++i) {
    put(i, i, matrix.diagonal()[i]);
    for (int k = pattern.start[i]; k < pattern.start[i + 1]; ++k) {
      put(i, pattern.column[k], matrix.lower()[k]);
      put(pattern.column[k], i, matrix.lower()[k].transpose());
    }
  }
  for (std::size_t k = 0; k < matrix.pairs().size(); ++k) {
    put(matrix.pairs()[k].row, matrix.pairs()[k].column, matrix.coupled()[k]);
    put(matrix.pairs()[k].column, matrix.pairs()[k].row, matrix.coupled()[k].transpose());
  }
  Eigen::SparseMatrix<double> result(3 * pattern.size, 3 * pattern.size);
  result.setFromTriplets(entries.begin(), entries.end());
  return result;
}

}  // namespace vibe::test
