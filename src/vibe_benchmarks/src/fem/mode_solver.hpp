#pragma once
#include <Eigen/Core>
#include <vector>

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

}  // namespace vibe::benchmarks
