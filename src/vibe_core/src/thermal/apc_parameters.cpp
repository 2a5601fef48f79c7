#include "vibe_core/thermal/apc_parameters.hpp"

#include <cstdio>
#include <string>

#include "vibe_core/common/error.hpp"

namespace vibe {

namespace {

void expect(const char* key, double value, double low, double high, const char* unit) {
  if (value >= low && value <= high) return;
  char text[160];
  std::snprintf(text, sizeof text, "marking.%s: %g is not from %g to %g %s; give a value in that range.", key, value,
                low, high, unit);
  throw Error(text);
}

}  // namespace

void ApcParameters::check() const {
  expect("power", power, 0, 200, "W");
  expect("efficiency", efficiency, 0, 1, "");
  expect("argon_flow", argon_flow, 0, 10 * kLitrePerMinute, "m^3/s");
  expect("probe_length", probe_length, 0, 0.1, "m");
  expect("reach", reach, 0, 0.05, "m");
  expect("spot_radius", spot_radius, 0.0005, 0.02, "m");
  expect("spread", spread, 0, 1, "rad");
  expect("mark_energy", mark_energy, 1e-3, 1e5, "J");
  expect("burn_energy", burn_energy, mark_energy, 1e5, "J");
  expect("deep_energy", deep_energy, burn_energy, 1e5, "J");
  expect("tissue_cooling", tissue_cooling, 0, 10, "1/s");
  expect("argon_cooling", argon_cooling, 0, 10, "1/s");
  expect("insufflation_cooling", insufflation_cooling, 0, 10, "1/s");
}

}  // namespace vibe
