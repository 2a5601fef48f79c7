#pragma once

#include <vector>

#include "vibe_graphics/geometry/tissue_mesh.hpp"

namespace vibe::graphics {

/// Time after which a mark is half way from white to brown, that is, tan. Design choice: sessions last 8 to 17 minutes,
/// in which the first marks shall be told from the last ones [s].
constexpr double kTanAge = 240;

/// How far a mark of this age has gone from white (0) over tan (1/2) to brown (1): 1 - 2^(-age / kTanAge).
/// @param age  [s]
double browning(double age);

/// The age of marks and burns: the time since their grade last rose, as far as it was seen. Those of the first frame
/// are new in it.
class ScarAge {
 public:
  explicit ScarAge(const TissueMesh& mesh);  ///< no marks yet

  /// @param frame  of this mesh. All marks are new again if its time is before that of the last frame, or if a grade
  ///               has fallen
  /// @return whether grades or browning have changed, in steps of 1/256
  bool see(const TissueFrame& frame);
  /// Grade times browning, one per vertex of the drawn surface, with the weights of its particles. Divided by the
  /// grade with the same weights it is the mean browning of the marked ones, whatever is not marked beside them.
  std::vector<float> browned() const;

 private:
  std::vector<std::uint32_t> render_offsets_, render_particles_;
  std::vector<float> render_weights_;
  std::vector<std::uint8_t> grade_;  ///< of the last frame; 0 before the first
  std::vector<double> since_;        ///< when the grade rose [s]
  std::vector<float> of_particle_;   ///< grade times browning
  double time_ = 0;                  ///< of the last frame [s]
};

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
  std::vector<double> share_;  ///< area of each particle, of that of a spot
  std::vector<float> dose_;    ///< of the last frame [J]; empty: there was none
  double time_ = 0;            ///< of the last frame [s]
  double energy_ = 0;
};

}  // namespace vibe::graphics
