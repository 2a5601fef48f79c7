#pragma once
#include <cstdint>
#include <vector>

#include "vibe_core/geometry/organ.hpp"
#include "vibe_core/thermal/argon_beam.hpp"

namespace vibe {

/// Effect of the beam on the wall. The values are part of the message format.
enum class BurnGrade : std::uint8_t {
  None = 0,
  Mark = 1,  ///< mucosa coagulated, as intended
  Burn = 2,  ///< a scar: mucosa and submucosa dead
  Deep = 3   ///< the muscularis is at risk
};
const char* toString(BurnGrade grade);

/// A particle whose grade has risen during a step.
struct Burn {
  int particle = -1;                  ///< its number
  BurnGrade grade = BurnGrade::None;  ///< that it has reached
  Wall wall = Wall::Anterior;         ///< where the particle is
  Region region = Region::Body;       ///< where the particle is
};

/// Flow of cooling gas [m^3/s].
struct GasFlow {
  double argon = 0;         ///< over the footprint of the beam
  double insufflation = 0;  ///< over the whole wall
};

/// The thermal model that converts beam power into marks and burns.
///
/// Each particle has a heat h, the energy per area that the wall holds above body temperature, and a dose D, the
/// largest h so far. Both are expressed as the energy of a whole spot: energy per area times the area of the footprint
/// at contact [J]. A beam held on a particle therefore raises h by power * time for any particle spacing, and published
/// energies per spot apply directly:
///   dh/dt = p - h / tau,  1/tau = tissue_cooling + argon_cooling * argon * cover + insufflation_cooling *
///   insufflation, D = max h,
/// solved exactly for constant p over a step, so results do not depend on the step size. The grade follows from D. Its
/// thresholds are the heat that a 40 W beam held on one spot has left there after applying mark_energy, burn_energy or
/// deep_energy. The same energy therefore burns less when applied in pulses with pauses, and more when applied by a
/// stronger beam. tau also accounts for heat conducted along and through the wall; this heat is not passed on to the
/// neighbours.
///
/// Limits: no temperature, no depth, no boiling of water, no influence of the foundation or of blood vessels.
class ThermalDose {
 public:
  /// @throws Error if parameters.check() throws
  explicit ThermalDose(const ApcParameters& parameters);

  BurnGrade grade(float dose) const;                     ///< of a dose [J]
  double threshold(BurnGrade grade) const;               ///< smallest dose of a grade [J]
  double coolingTime(GasFlow flow, double cover) const;  ///< tau; infinity without cooling [s]

  /// Advances all particles by one step.
  /// @param shares  of the beam; empty while it is off
  /// @param dt      [s]
  /// @param heat, dose  (particles) [J]
  /// @param burns   particles whose grade has risen are appended, in the order of the shares
  /// @throws Error if heat or dose do not have the size of the organ
  void advance(const Organ& organ, const std::vector<BeamShare>& shares, GasFlow flow, double dt,
               std::vector<float>& heat, std::vector<float>& dose, std::vector<Burn>& burns) const;

 private:
  double retained(double energy) const;

  ApcParameters parameters_;
  double thresholds_[4] = {};
};

}  // namespace vibe
