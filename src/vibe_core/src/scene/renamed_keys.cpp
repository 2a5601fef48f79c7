#include "scene/renamed_keys.hpp"

namespace vibe {

const std::vector<RenamedKey>& renamedKeys() {
  static const std::vector<RenamedKey> keys = {
      {"bed", "foundation"},
      {"tissue.damping_rate", "tissue.mass_damping"},
      {"tissue.damping_time", "tissue.stiffness_damping"},
      {"helix.prick_force", "helix.initial_hold_force"},
      {"suture.least_bites", "suture.min_bites"},
      {"suture.most_bites", "suture.max_bites"},
      {"suture.pulling", "suture.cinch_model"},
      {"suture.technique_rule", "suture.classifier"},
      {"skin", "render_surface"},
  };
  return keys;
}

const char* newNameOf(const std::string& key) {
  for (const RenamedKey& renamed : renamedKeys())
    if (key == renamed.old_key) return renamed.new_key;
  return nullptr;
}

}  // namespace vibe
