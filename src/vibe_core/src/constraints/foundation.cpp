#include "constraints/foundation.hpp"

namespace vibe {

std::vector<double> foundationSprings(const Scene& scene, const std::vector<double>& areas) {
  std::vector<double> springs;
  if (scene.foundation)
    for (double area : areas) springs.push_back(scene.foundation->stiffness * area);
  return springs;
}

}  // namespace vibe
