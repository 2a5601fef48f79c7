#include "vibe_core/thermal/thermal_dose.hpp"

#include <cmath>
#include <limits>
#include <string>

#include "arithmetic/elementary.hpp"
#include "vibe_core/program/error.hpp"
#include "vibe_core/program/word_of.hpp"

namespace vibe {

namespace {

constexpr double kReferencePower = 40;  // [W] of the publications on burns, and the higher power of those on marks
constexpr double kReferenceArgon = 1 * kLitrePerMinute;  // [m^3/s]
constexpr float kCold = 1e-15f;  // [J] smaller values become 0: endless decay would end in slow denormal numbers

/// Rate of cooling [1/s].
double coolingRate(const ApcParameters& p, GasFlow flow, double cover) {
  return p.tissue_cooling +
         (p.argon_cooling * flow.argon * cover + p.insufflation_cooling * flow.insufflation) / kLitrePerMinute;
}

/// Integral of exp(-rate s) over s from 0 to dt.
double heldTime(double rate, double dt) {
  return rate * dt > 1e-12 ? -math::expm1(-rate * dt) / rate : dt;
}

}  // namespace

const char* toString(BurnGrade grade) {
  return wordOf(grade, {"none", "mark", "burn", "deep"});
}

ThermalDose::ThermalDose(const ApcParameters& parameters) : parameters_(parameters) {
  parameters_.check();
  thresholds_[1] = retained(parameters_.mark_energy);
  thresholds_[2] = retained(parameters_.burn_energy);
  thresholds_[3] = retained(parameters_.deep_energy);
}

/// Heat that remains in a spot after the reference beam has applied this energy [J].
double ThermalDose::retained(double energy) const {
  const double rate = coolingRate(parameters_, {kReferenceArgon, 0}, 1);
  return kReferencePower * heldTime(rate, energy / kReferencePower);
}

BurnGrade ThermalDose::grade(float dose) const {
  int g = 3;
  while (g > 0 && !(static_cast<double>(dose) >= thresholds_[g])) --g;
  return static_cast<BurnGrade>(g);
}

double ThermalDose::threshold(BurnGrade grade) const {
  return thresholds_[static_cast<int>(grade)];
}

double ThermalDose::coolingTime(GasFlow flow, double cover) const {
  const double rate = coolingRate(parameters_, flow, cover);
  return rate > 0 ? 1 / rate : std::numeric_limits<double>::infinity();
}

void ThermalDose::advance(const Organ& organ, const std::vector<BeamShare>& shares, GasFlow flow, double dt,
                          std::vector<float>& heat, std::vector<float>& dose, std::vector<Burn>& burns) const {
  if (heat.size() != organ.wall.size() || dose.size() != organ.wall.size()) {
    throw Error("marking: heat and dose have " + std::to_string(heat.size()) + " and " + std::to_string(dose.size()) +
                " entries for " + std::to_string(organ.wall.size()) + " particles; make them with the state.");
  }
  const double everywhere = coolingRate(parameters_, flow, 0);
  const auto kept = static_cast<float>(math::exp(-everywhere * dt));
  for (float& h : heat) h = h > kCold ? h * kept : 0;
  for (const BeamShare& share : shares) {
    const double rate = coolingRate(parameters_, flow, share.cover);
    const double old = static_cast<double>(heat[share.particle]) * math::exp(-(rate - everywhere) * dt);
    heat[share.particle] = static_cast<float>(old + share.spot_power * heldTime(rate, dt));
    if (!(heat[share.particle] > dose[share.particle])) continue;
    const BurnGrade before = grade(dose[share.particle]);
    dose[share.particle] = heat[share.particle];
    const BurnGrade after = grade(dose[share.particle]);
    if (after != before)
      burns.push_back({share.particle, after, organ.wall[share.particle], organ.region[share.particle]});
  }
}

}  // namespace vibe
