#include <metis.h>

#include <mutex>
#include <string>

#include "sparse/elimination.hpp"
#include "vibe_core/common/error.hpp"

namespace vibe {
namespace {

struct Graph {
  std::vector<idx_t> node;   // node of the pattern by vertex; only nodes coupled with another one
  std::vector<idx_t> start;  // both directions of every edge, as METIS requires
  std::vector<idx_t> neighbour;
};

std::vector<std::vector<int>> neighbours(const BlockPattern& pattern) {
  std::vector<std::vector<int>> list(pattern.size);
  for (int i = 0; i < pattern.size; ++i)
    for (int k = pattern.start[i]; k < pattern.start[i + 1]; ++k) {
      list[i].push_back(pattern.column[k]);
      list[pattern.column[k]].push_back(i);
    }
  return list;
}

Graph coupledNodes(const BlockPattern& pattern) {
  const std::vector<std::vector<int>> list = neighbours(pattern);
  std::vector<idx_t> vertex(pattern.size, -1);
  Graph graph;
  for (int i = 0; i < pattern.size; ++i)
    if (!list[i].empty()) {
      vertex[i] = static_cast<idx_t>(graph.node.size());
      graph.node.push_back(i);
    }
  graph.start.push_back(0);
  for (const idx_t node : graph.node) {
    for (const int other : list[node]) graph.neighbour.push_back(vertex[other]);
    graph.start.push_back(static_cast<idx_t>(graph.neighbour.size()));
  }
  return graph;
}

// METIS uses the C library's rand() with one state for the whole program; computing two plans at once would mix them
std::mutex& metisMutex() {
  static std::mutex mutex;
  return mutex;
}

}  // namespace

std::vector<int> nestedDissection(const BlockPattern& pattern, int seed) {
  Graph graph = coupledNodes(pattern);
  std::vector<int> order;
  std::vector<char> coupled(pattern.size, 0);
  for (const idx_t node : graph.node) coupled[node] = 1;
  for (int i = 0; i < pattern.size; ++i)
    if (!coupled[i]) order.push_back(i);  // isolated nodes need no ordering and are not passed to METIS
  if (graph.node.empty()) return order;

  idx_t options[METIS_NOPTIONS];
  METIS_SetDefaultOptions(options);
  options[METIS_OPTION_SEED] = seed;
  options[METIS_OPTION_UFACTOR] =
      400;  // halves of up to 1 : 1.4 allow shorter separators: 4 % fewer numbers in the factor of a shell
  options[METIS_OPTION_NUMBERING] = 0;
  idx_t count = static_cast<idx_t>(graph.node.size());
  std::vector<idx_t> vertex_order(count), place(count);
  const std::lock_guard<std::mutex> lock(metisMutex());
  const int status = METIS_NodeND(&count, graph.start.data(), graph.neighbour.data(), nullptr, options,
                                  vertex_order.data(), place.data());
  if (status != METIS_OK)
    throw Error("METIS cannot order a matrix of " + std::to_string(pattern.size) + " nodes (status " +
                std::to_string(status) + "): give it more memory, or a smaller mesh.");
  for (const idx_t vertex : vertex_order) order.push_back(graph.node[vertex]);
  return order;
}

}  // namespace vibe
