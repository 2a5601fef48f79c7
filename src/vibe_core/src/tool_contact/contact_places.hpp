#pragma once

#include <vector>

#include "vibe_core/geometry/organ.hpp"
#include "vibe_core/tool_contact/tool_contact.hpp"

namespace vibe {

/// Says where on an organ a contact of the tool is.
class ContactPlaces {
 public:
  /// @param organ  must outlive this
  explicit ContactPlaces(const Organ& organ);

  /// Sets triangle, region and wall of a contact from the nodes of its `surface`.
  void place(ToolContact& contact) const;

 private:
  const Organ& organ_;
  std::vector<int> start_, triangle_;  // triangles at each vertex, ascending
};

/// Sets region and wall of a contact to those of a node.
void placeAtNode(const Organ& organ, int node, ToolContact& contact);

}  // namespace vibe
