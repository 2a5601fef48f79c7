#pragma once
#include <array>
#include <vector>

#include "vibe_core/solver/energy_term.hpp"

namespace vibe::benchmarks {

/// A constant pressure on the surface halfway between an inner and an outer layer of nodes: energy -p V, where V is the
/// volume inside that closed surface. For walls whose elements have no gas.
class LayerPressure : public EnergyTerm {
 public:
  /// @param triangles   of the inner layer, outwards
  /// @param inner_count nodes of one layer; node n + inner_count lies outside node n
  LayerPressure(std::vector<std::array<int, 3>> triangles, int inner_count)
      : triangles_(std::move(triangles)), inner_count_(inner_count) {}

  void setPressure(double pressure) { pressure_ = pressure; }  ///< [Pa]
  double evaluate(const double* positions4, float* gradient4) const override;

 private:
  std::vector<std::array<int, 3>> triangles_;
  int inner_count_;
  double pressure_ = 0;
};

}  // namespace vibe::benchmarks
