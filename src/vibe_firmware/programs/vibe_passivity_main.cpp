#include <cstdio>
#include <cstring>

#include "pump_search.hpp"
#include "vibe_firmware/core/passivity.hpp"

// Prints the region of stiffness and damping that is passive, for the plot of docs/hardware.md: the boundary of the
// conditions and, around it, what the pump search finds. One line of CSV per point.

namespace {

using namespace vibe_firmware;

struct Transmission {
  const char* name;
  AxisConfig config;
};

AxisConfig capstan() {
  AxisConfig config;
  config.safety_factor = 1;
  config.output_delay = 0;
  return config;
}

/// The same motor and encoder without the capstan of n = 10.
AxisConfig directDrive() {
  AxisConfig config = capstan();
  config.radians_per_count *= 10;
  config.viscous_friction /= 100;
  config.coulomb_friction /= 10;
  config.torque_limit /= 10;
  config.speed_limit *= 10;
  return config;
}

/// Largest gain of narrow and wide motions [J per tick].
double gain(const AxisConfig& config, float stiffness, float damping) {
  AxisParameters parameters;
  parameters.stiffness = stiffness;
  parameters.damping = damping;
  parameters.torque_limit = config.torque_limit;
  double most = 0;
  for (const int stride : {1, 24, 40}) {
    const double found = PumpSearch(config, parameters, {3, stride, 127}).run().gain;
    if (found > most) most = found;
  }
  return most;
}

void printPoint(const char* name, const char* kind, float damping, float stiffness, double value) {
  std::printf("%s,%s,%.6g,%.6g,%.4g\n", name, kind, static_cast<double>(damping), static_cast<double>(stiffness),
              value);
}

/// Points on rays from the origin: on the boundary, then at multiples of it.
void printTransmission(const Transmission& transmission, int rays) {
  const AxisConfig& config = transmission.config;
  AxisConfig suggested = config;
  suggested.safety_factor = AxisConfig{}.safety_factor;
  suggested.output_delay = AxisConfig{}.output_delay;
  for (int i = 0; i <= rays; ++i) {
    const float share = static_cast<float>(i) / static_cast<float>(rays);
    const float damping = share * maxDamping(config, 0);
    const float stiffness = maxStiffness(config, damping);
    printPoint(transmission.name, "limit", damping, stiffness, 0);
    const float accepted = share * maxDamping(suggested, 0);
    printPoint(transmission.name, "accepted", accepted, maxStiffness(suggested, accepted), 0);
    for (const float scale : {0.25F, 0.5F, 0.75F, 0.9F, 1.0F, 1.05F, 1.1F, 1.25F})
      printPoint(transmission.name, "search", scale * damping, scale * stiffness,
                 gain(config, scale * stiffness, scale * damping));
  }
}

constexpr const char* kHelp =
    "Usage: vibe_passivity\n"
    "Prints stiffness and damping that the haptic device renders passively, as CSV:\n"
    "transmission, kind (limit, accepted, search), damping [N m s/rad], stiffness [N m/rad], energy gain [J/tick]\n"
    "limit: boundary of the passivity conditions; accepted: with the safety factor and output delay of the default\n"
    "configuration; search: what a hand can gain per tick at most, driving the real control function.\n";

}  // namespace

int main(int argc, char** argv) {
  if (argc == 2 && std::strcmp(argv[1], "--help") == 0) {
    std::fputs(kHelp, stdout);
    return 0;
  }
  if (argc > 1) {
    std::fprintf(stderr, "Unknown argument '%s'; see vibe_passivity --help.\n", argv[1]);
    return 2;
  }
  std::puts("transmission,kind,damping,stiffness,gain");
  printTransmission({"capstan", capstan()}, 12);
  printTransmission({"direct", directDrive()}, 12);
}
