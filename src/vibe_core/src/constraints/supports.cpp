#include "constraints/supports.hpp"

namespace vibe {

std::vector<char> attachedNodes(const Scene& scene, const Organ& organ) {
  std::vector<char> attached;
  for (const End end : organ.end) attached.push_back(isHeld(scene, end) ? 1 : 0);
  return attached;
}

std::vector<double> foundationSprings(const Scene& scene, const std::vector<double>& areas) {
  std::vector<double> springs;
  if (scene.foundation)
    for (double area : areas) springs.push_back(scene.foundation->stiffness * area);
  return springs;
}

}  // namespace vibe
