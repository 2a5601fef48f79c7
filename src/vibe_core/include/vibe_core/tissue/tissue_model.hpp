#pragma once
#include <string>
#include <vector>

namespace vibe {

struct State;

/// The elastic law of the wall on its rest shape: what any solver needs to know of it. Constant after building.
/// Implementations are listed in tissue_registry.cpp.
class TissueModel {
 public:
  virtual ~TissueModel() = default;

  /// The name under which scenes ask for it (tissue.model).
  virtual std::string name() const = 0;

  /// Stored elastic energy at the positions and orientations of `state` [J].
  virtual double energy(const State& state) const = 0;

  /// Adds the elastic force on every particle [N]; arrays of (particle count).
  virtual void addForces(const State& state, double* fx, double* fy, double* fz) const = 0;

  /// Mean in-plane stretch around each particle against rest, minus 1 [1]; array of (particle count).
  virtual void strain(const State& state, float* out) const = 0;

  /// Simulated stiffness over asked stiffness, the worst over the wall: below 1 the solver's sub-steps are too long
  /// for the asked modulus and the wall is softer than asked.
  virtual double stiffnessRatio() const = 0;
};

}  // namespace vibe
