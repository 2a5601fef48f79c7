#pragma once
#include <string>
#include <vector>

namespace vibe {

struct State;

/// The elasticity of a wall with a given rest shape, independent of the solver. Constant after construction.
/// Implementations: see builder/tissue_registry.hpp.
class TissueModel {
 public:
  virtual ~TissueModel() = default;

  /// Name of the model; for built-in models the value of tissue.model.
  virtual std::string name() const = 0;

  /// Stored elastic energy at the positions and orientations of `state` [J].
  virtual double energy(const State& state) const = 0;

  /// Adds the elastic force on every particle [N]; arrays of (particle count).
  virtual void addForces(const State& state, double* fx, double* fy, double* fz) const = 0;

  /// Mean in-plane stretch around each particle relative to rest, minus 1; array of (particle count).
  virtual void strain(const State& state, float* out) const = 0;

  /// Ratio of simulated to requested stiffness, the minimum over the wall. Below 1, the substeps are too long for the
  /// requested modulus, and the wall is softer than requested.
  virtual double stiffnessRatio() const = 0;
};

}  // namespace vibe
