#pragma once

#include <array>

#include <Eigen/Core>

#include "vibe_core/sparse/factor.hpp"

namespace vibe {

// What a factor makes of the columns of nodes, half solved: products and sums of these sparse vectors.

/// Product of two sparse vectors: both consist of whole runs; those on the common part of the paths are the same runs.
Eigen::Matrix3f product(const HalfColumns& a, const HalfColumns& b);
/// Products at once. Design choice: as many sums as it takes that an addition need not wait for the one before.
constexpr int kProducts = 4;
/// The same of several at once, with the same bits. Alone, each is a sum in which every term waits for the one before;
/// together they share what their paths have in common.
/// @param out  kProducts of them
void productsOf(const std::array<const HalfColumns*, kProducts>& columns, const HalfColumns& b, Eigen::Matrix3f* out);
/// Product with a dense vector.
Eigen::Vector3f product(const HalfColumns& a, const float* y);
/// Several at once, likewise.
void productsOf(const std::array<const HalfColumns*, kProducts>& columns, const float* y, Eigen::Vector3f* out);
/// Rows of a dense vector, past the last.
struct RowRange {
  int first, last;
};
/// Adds the columns times c to some rows of a dense vector.
void addProduct(const HalfColumns& a, const Eigen::Vector3f& c, RowRange rows, float* y);
/// Adds weight times the columns b to a.
void addScaled(const HalfColumns& b, float weight, HalfColumns& a);

}  // namespace vibe
