#include "constraints/attachment.hpp"

#include "scene/attachments.hpp"

namespace vibe {

std::vector<char> attachedNodes(const Scene& scene, const Organ& organ) {
  std::vector<char> attached;
  for (const End end : organ.end) attached.push_back(isHeld(scene, end) ? 1 : 0);
  return attached;
}

}  // namespace vibe
