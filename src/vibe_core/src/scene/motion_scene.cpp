#include <array>

#include "vibe_core/scene/scene.hpp"

namespace vibe {

double gradeOf(const MotionScene& motion) {
  return std::array{0.0, 0.5, 1.0, 1.25}.at(static_cast<std::size_t>(motion.grade));
}

std::optional<BreathingScene> breathingOf(const Scene& scene) {
  if (scene.breathing || !scene.motion) return scene.breathing;
  constexpr double kDeformation = 20e-3, kInspiration = 0.4;  // see the section `motion` of scenes
  BreathingScene healthy;
  healthy.amplitude *= gradeOf(*scene.motion);
  healthy.deformation = kDeformation * gradeOf(*scene.motion);
  healthy.inspiration = kInspiration;
  return healthy;
}

}  // namespace vibe
