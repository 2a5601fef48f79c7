#include "tool_contact/contact_places.hpp"

#include <algorithm>

namespace vibe {

ContactPlaces::ContactPlaces(const Organ& organ)
    : organ_(organ), start_(organ.surface.vertices.size() + 1, 0), triangle_(3 * organ.surface.triangles.size()) {
  const auto& triangles = organ.surface.triangles;
  for (const auto& nodes : triangles)
    for (const int node : nodes) ++start_[node + 1];
  for (std::size_t v = 1; v < start_.size(); ++v) start_[v] += start_[v - 1];
  std::vector<int> next(start_.begin(), start_.end() - 1);
  for (std::size_t t = 0; t < triangles.size(); ++t)
    for (const int node : triangles[t]) triangle_[next[node]++] = static_cast<int>(t);
}

void ContactPlaces::place(ToolContact& contact) const {
  const SurfacePoint& point = contact.surface;
  const auto has_all = [&](int triangle) {
    const auto& nodes = organ_.surface.triangles[triangle];
    return std::all_of(point.node.begin(), point.node.begin() + point.count,
                       [&](int node) { return std::find(nodes.begin(), nodes.end(), node) != nodes.end(); });
  };
  const auto begin = triangle_.begin() + start_[point.node[0]], end = triangle_.begin() + start_[point.node[0] + 1];
  const auto found = std::find_if(begin, end, has_all);
  contact.triangle = found == end ? -1 : *found;
  const auto heaviest = std::max_element(point.weight.begin(), point.weight.begin() + point.count);
  placeAtNode(organ_, point.node[heaviest - point.weight.begin()], contact);
}

void placeAtNode(const Organ& organ, int node, ToolContact& contact) {
  contact.region = organ.region[node];
  contact.wall = organ.wall[node];
}

}  // namespace vibe
