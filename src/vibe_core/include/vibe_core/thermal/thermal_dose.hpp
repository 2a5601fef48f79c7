#pragma once
#include <cstdint>
#include <vector>

#include "vibe_core/geometry/organ.hpp"
#include "vibe_core/thermal/apc_parameters.hpp"
#include "vibe_core/thermal/argon_beam.hpp"

namespace vibe {

/// What the beam has done to the wall. The numbers go on the wire.
enum class BurnGrade : std::uint8_t {
  None = 0,
  Mark = 1,  ///< mucosa coagulated, as intended
  Burn = 2,  ///< a scar: mucosa and submucosa dead
  Deep = 3   ///< the muscularis is at risk
};
const char* toString(BurnGrade grade);

/// A particle whose grade has risen in a step.
struct Burn {
  int particle = -1;
  BurnGrade grade = BurnGrade::None;
  Wall wall = Wall::Anterior;
  Region region = Region::Body;
};

/// Gas that takes heat away [m^3/s].
struct GasFlow {
  double argon = 0;         ///< over the footprint of the beam
  double insufflation = 0;  ///< over the whole wall
};

/// The law that turns the beam's heat into marks and burns.
///
/// Per particle: heat h, the energy per area that the wall holds above body temperature, and dose D, the largest h so
/// far. Both are told as the energy of a whole spot: times the area of the footprint at contact [J]. A beam held on a
/// particle so raises h by power * time whatever the distance of the particles is, and published energies per spot
/// apply as they are:
///   dh/dt = p - h / tau,  1/tau = tissue_cooling + argon_cooling * argon * cover + insufflation_cooling *
///   insufflation, D = max h,
/// solved exactly for a p that is constant over a step, so results do not depend on the length of steps. The grade is
/// that of D. Its thresholds are what a beam of 40 W that is held on one spot has left there after it has given
/// mark_energy, burn_energy or deep_energy; so the same energy in pulses with pauses burns less, and by a stronger beam
/// more. tau also stands for heat that is conducted along and through the wall: neighbours do not get it.
///
/// Limits: no temperature, no depth, no water that boils off; the foundation and blood vessels do not matter.
class ThermalDose {
 public:
  /// @throws Error if parameters.check() does
  explicit ThermalDose(const ApcParameters& parameters);

  BurnGrade grade(float dose) const;                     ///< of a dose [J]
  double threshold(BurnGrade grade) const;               ///< least dose of a grade [J]
  double coolingTime(GasFlow flow, double cover) const;  ///< tau; infinity without cooling [s]

  /// One step of all particles.
  /// @param shares  of the beam; empty while it is off
  /// @param dt      [s]
  /// @param heat, dose  (particles) [J]
  /// @param burns   particles whose grade has risen are appended, in the order of the shares
  /// @throws Error if heat or dose have another size than the organ
  void advance(const Organ& organ, const std::vector<BeamShare>& shares, GasFlow flow, double dt,
               std::vector<float>& heat, std::vector<float>& dose, std::vector<Burn>& burns) const;

 private:
  double retained(double energy) const;

  ApcParameters parameters_;
  double thresholds_[4] = {};
};

}  // namespace vibe
