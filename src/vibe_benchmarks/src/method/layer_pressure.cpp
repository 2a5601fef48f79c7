#include "method/layer_pressure.hpp"

#include <Eigen/Geometry>

namespace vibe::benchmarks {

double LayerPressure::evaluate(const double* positions4, float* gradient4) const {
  const auto middle = [&](int n) {
    const double *const in = positions4 + 4 * n, *const out = in + 4 * inner_count_;
    return Eigen::Vector3d(0.5 * (in[0] + out[0]), 0.5 * (in[1] + out[1]), 0.5 * (in[2] + out[2]));
  };
  double volume = 0;
  for (const auto& t : triangles_) {
    const std::array<Eigen::Vector3d, 3> p{middle(t[0]), middle(t[1]), middle(t[2])};
    volume += p[0].dot(p[1].cross(p[2])) / 6;
    for (std::size_t k = 0; k < 3; ++k) {
      const Eigen::Vector3d slope = -pressure_ / 12 * p[(k + 1) % 3].cross(p[(k + 2) % 3]);  // half to each layer
      for (int axis = 0; axis < 3; ++axis) {
        gradient4[4 * t[k] + axis] += static_cast<float>(slope[axis]);
        gradient4[4 * (t[k] + inner_count_) + axis] += static_cast<float>(slope[axis]);
      }
    }
  }
  return -pressure_ * volume;
}

}  // namespace vibe::benchmarks
