#pragma once
#include <Eigen/Core>
#include <vector>

#include "vibe_vision/track/marker_pattern.hpp"

namespace vibe::vision {

/// Sums of products of columns of floats, always in the same order and without fused operations: the same bits on every
/// machine.
class NormalEquations {
 public:
  static constexpr int kMaxColumns = 16;

  explicit NormalEquations(std::size_t capacity);

  /// Begins anew with this number of columns.
  void start(int columns);
  float* column(int k) { return columns_.data() + static_cast<std::size_t>(k) * capacity_; }
  float* residual() { return column(kMaxColumns); }
  /// @param count  rows, a multiple of kLanes
  void sum(std::size_t count);

  double product(int a, int b) const { return a < b ? products_(a, b) : products_(b, a); }
  double gradient(int a) const { return products_(a, kMaxColumns); }

 private:
  void sumGroup(int a, int b, std::size_t begin, std::size_t rows);

  std::size_t capacity_;
  int count_ = 0;
  std::vector<float> columns_;
  Eigen::Matrix<double, kMaxColumns + 1, kMaxColumns + 1> products_;
};

}  // namespace vibe::vision
