#include "sparse/order_repair.hpp"

#include <algorithm>

namespace vibe {
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
