#pragma once
#include <vector>

#include "geometry/tissue_mesh.hpp"

namespace vibe::rviz_plugins {

// Design choices: nothing is published on the smoke of argon plasma coagulation in a stomach.
constexpr double kSmokeLife =
    15;  ///< mean time that smoke stays: long enough to wait for, short against a mark's way [s]
/// Extinction of the smoke of one joule. A mark of 1.5 s at 40 W leaves 55 J on the wall: then 74 % of the light comes
/// back from a wall at 40 mm and 46 % from one at 100 mm, veiled, but recognisable [1/(m J)].
constexpr double kSmokePerJoule = 0.07;
/// Limit: 53 % of the light comes back from a wall at 40 mm, so that a row of marks does not blind a trainee, who has
/// no suction to clear it [1/m].
constexpr double kDensestSmoke = 8;
constexpr double kSpotRadius = 4e-3;  ///< of the footprint that doses refer to, the default of scenes [m]

/// Smoke of the tissue that the argon beam burns. The lumen is well mixed, so one number tells all; it grows with the
/// newly burnt energy and decays:
///   dS/dt = burnt power - S / kSmokeLife,
/// solved exactly between two frames with the mean power between them, so the result does not depend on the rate of
/// the frames where the beam is on or off throughout. Burnt energy is the increase of the dose (the largest heat so
/// far), so tissue that is heated again smokes only as it gets hotter than ever. What was burnt before the first frame
/// does not smoke.
class Smoke {
 public:
  /// Doses are energies on a spot; with the areas at rest, the energy on the organ does not depend on its mesh.
  explicit Smoke(const TissueMesh& mesh);

  /// @param frame  of this mesh. The smoke is gone if its time is before that of the last frame, or if a dose has
  /// fallen
  void see(const TissueFrame& frame);
  double energy() const { return energy_; }  ///< S, the energy whose smoke is in the lumen [J]
  double extinction() const;                 ///< of light by the smoke, at most kDensestSmoke [1/m]

 private:
  std::vector<double> share_;  ///< area of each particle, of that of a spot [1]
  std::vector<float> dose_;    ///< of the last frame [J]; empty: there was none
  double time_ = 0;            ///< of the last frame [s]
  double energy_ = 0;
};

}  // namespace vibe::rviz_plugins
