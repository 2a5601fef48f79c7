#pragma once

#include <vector>

#include <Eigen/Core>

#include "vibe_core/solver/elastic_body.hpp"

namespace vibe::benchmarks {

/// The lowest free vibration modes of a body about rest: K phi = (2 pi f)^2 M phi, M lumped, fixed nodes at rest.
struct Modes {
  std::vector<double> frequency;  ///< [Hz], ascending
  Eigen::MatrixXd shape;          ///< a column per mode (3 * nodes), largest node displacement 1
};

/// Computed by subspace iteration (Bathe, Wilson 1972) with the factor of K in double precision, to 1e-9 of each
/// frequency.
/// @throws Error if K is not positive definite: the body can move without strain
Modes slowestModes(const ElasticBody& body, int count);

/// Properties of a vibration about 0, from its values at equal steps.
struct Oscillation {
  double frequency =
      0;  ///< from the first to the last zero crossing in the same direction [Hz]; NaN: less than one period
  double kept =
      0;  ///< ratio of the amplitude to that one period earlier, mean over all periods; NaN: less than one period
};

Oscillation measureOscillation(const std::vector<double>& values, double step);

}  // namespace vibe::benchmarks
