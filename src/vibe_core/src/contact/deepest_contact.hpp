#pragma once

#include <vector>

#include "contact/tool_collision.hpp"

namespace vibe {

/// Calls `use` once per touched particle, with its deepest contact. Where shapes overlap, this contact leads out of
/// both.
/// @param contacts  in the order of their particles
template <class Use>
void forEachDeepest(const std::vector<Contact>& contacts, Use use) {
  for (std::size_t first = 0, next; first < contacts.size(); first = next) {
    std::size_t deepest = first;
    for (next = first + 1; next < contacts.size() && contacts[next].particle == contacts[first].particle; ++next)
      if (contacts[next].distance < contacts[deepest].distance) deepest = next;
    use(contacts[deepest]);
  }
}

}  // namespace vibe
