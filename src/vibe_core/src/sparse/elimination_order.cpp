#include <algorithm>
#include <mutex>
#include <string>

#include <metis.h>

#include "sparse/elimination.hpp"
#include "vibe_core/program/error.hpp"

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

namespace {

/// Pairs across branches, and the nodes that move because of them.
class Repair {
 public:
  Repair(const FactorPlan& base, const std::vector<NodePair>& pairs)
      : base_(base),
        top_(static_cast<int>(base.fronts.size())),
        target_(base.position.size(), -1),
        open_(base.position.size(), 0) {
    for (const NodePair& pair : pairs) {
      const int meeting = meetingOf(pair);
      if (meeting != holder(pair.row) && meeting != holder(pair.column)) crossing_.push_back({pair, meeting});
    }
  }

  std::vector<int> order() {
    for (const Crossing& c : crossing_) ++open_[c.pair.row], ++open_[c.pair.column];
    while (!crossing_.empty()) move(mostConnected());
    return reordered();
  }

 private:
  struct Crossing {
    NodePair pair;
    int meeting;  // lowest supernode that is an ancestor of both nodes; top_: none
  };

  int holder(int node) const { return base_.holder[base_.position[node]]; }
  int above(int supernode) const {
    const int parent = base_.fronts[supernode].parent;
    return parent == -1 ? top_ : parent;
  }
  // parents have larger numbers than their children
  int meetingOf(const NodePair& pair) const {
    int a = holder(pair.row), b = holder(pair.column);
    while (a != b) (a < b ? a : b) = above(std::min(a, b));
    return a;
  }

  // among equals the one that is eliminated last, whose path is the shortest
  int mostConnected() const {
    int best = crossing_.front().pair.row;
    const auto offer = [&](int node) {
      if (open_[node] > open_[best] || (open_[node] == open_[best] && base_.position[node] > base_.position[best]))
        best = node;
    };
    for (const Crossing& c : crossing_) offer(c.pair.row), offer(c.pair.column);
    return best;
  }

  void move(int node) {
    const auto settled = [&](const Crossing& c) {
      if (c.pair.row != node && c.pair.column != node) return false;
      target_[node] = std::max(target_[node], c.meeting);
      --open_[c.pair.row], --open_[c.pair.column];
      return true;
    };
    crossing_.erase(std::remove_if(crossing_.begin(), crossing_.end(), settled), crossing_.end());
    moved_.push_back(node);
  }

  std::vector<int> reordered() {
    std::sort(moved_.begin(), moved_.end(), [&](int a, int b) {
      return target_[a] != target_[b] ? target_[a] < target_[b] : base_.position[a] < base_.position[b];
    });
    std::vector<int> order;
    order.reserve(base_.order.size());
    auto next = moved_.begin();
    for (const int node : base_.order) {
      for (; next != moved_.end() && target_[*next] <= holder(node); ++next) order.push_back(*next);
      if (target_[node] == -1) order.push_back(node);
    }
    order.insert(order.end(), next, moved_.end());
    return order;
  }

  const FactorPlan& base_;
  int top_;
  std::vector<Crossing> crossing_;
  std::vector<int> target_;  // per node: supernode before which it is eliminated; -1: it stays
  std::vector<int> open_;    // per node: pairs in crossing_
  std::vector<int> moved_;
};

}  // namespace

std::vector<int> repairedOrder(const FactorPlan& base, const std::vector<NodePair>& pairs) {
  return Repair(base, pairs).order();
}

}  // namespace vibe
