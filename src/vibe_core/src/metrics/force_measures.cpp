#include "vibe_core/metrics/force_measures.hpp"

#include <algorithm>
#include <cmath>

#include "vibe_core/common/error.hpp"

namespace vibe {

ForceRecorder::ForceRecorder(const ForceSettings& settings) : settings_(settings) {
  if (!(settings.threshold >= 0 && settings.noise >= 0 && std::isfinite(settings.threshold + settings.noise)))
    throw Error("A ForceRecorder needs a threshold and a noise of 0 N or more; correct its settings.");
}

void ForceRecorder::add(double magnitude, double dt) {
  if (!(magnitude >= 0) || !(dt > 0) || !std::isfinite(magnitude + dt))
    throw Error("A ForceRecorder was given a force or a step that is not a finite number; leave such steps out.");
  sums_.time += dt;
  sums_.impulse += magnitude * dt;
  sums_.max = std::max(sums_.max, magnitude);
  if (magnitude > settings_.threshold) sums_.time_above += dt;
  if (magnitude > settings_.noise) {
    sums_.loaded_time += dt;
    loaded_impulse_ += magnitude * dt;
  }
}

ForceMeasures ForceRecorder::measures() const {
  ForceMeasures m = sums_;
  if (m.loaded_time > 0) m.mean = loaded_impulse_ / m.loaded_time;
  if (m.time > 0) m.share_above = m.time_above / m.time;
  return m;
}

}  // namespace vibe
