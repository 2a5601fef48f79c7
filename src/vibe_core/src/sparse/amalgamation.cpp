#include <algorithm>

#include "sparse/elimination.hpp"

namespace vibe {

// Measured on the AVX2 path: the entries of a panel stream at about kNumber cycles each (both passes). Every row of a
// supernode is gathered and scattered once. Every tile of 8 columns and every supernode has a fixed overhead.
double solveCost(int nodes, int rows) {
  constexpr double kNumber = 0.25, kRow = 2.5, kTile = 30, kSupernode = 120;
  const double columns = 3.0 * nodes, all_rows = columns + 3.0 * rows;
  const double numbers = columns * (all_rows + 4 - columns / 2);
  return kNumber * numbers + kRow * all_rows + kTile * (columns / 8 + 1) + kSupernode;
}

namespace {

class Merger {
 public:
  explicit Merger(std::vector<Supernode> supernodes)
      : supernodes_(std::move(supernodes)), children_(supernodes_.size()) {
    for (std::size_t s = 0; s < supernodes_.size(); ++s)
      if (supernodes_[s].parent != -1) children_[supernodes_[s].parent].push_back(static_cast<int>(s));
  }

  std::vector<Supernode> run() {
    for (std::size_t s = 0; s < supernodes_.size(); ++s)
      while (absorbBestChild(static_cast<int>(s))) continue;
    return inPostorder();
  }

 private:
  static int size(const std::vector<int>& list) { return static_cast<int>(list.size()); }

  double gain(const Supernode& child, const Supernode& parent) const {
    const int nodes = size(child.nodes), own = size(parent.nodes), rows = size(parent.rows);
    return solveCost(nodes, size(child.rows)) + solveCost(own, rows) - solveCost(nodes + own, rows);
  }

  bool absorbBestChild(int s) {
    Supernode& parent = supernodes_[s];
    double best_gain = 0;
    int best = -1;
    for (const int child : children_[s]) {
      const double child_gain = gain(supernodes_[child], parent);
      if (child_gain <= best_gain) continue;
      best_gain = child_gain;
      best = child;
    }
    if (best != -1) absorb(s, best);
    return best != -1;
  }

  void absorb(int s, int child) {
    std::vector<int>& nodes = supernodes_[s].nodes;
    std::vector<int>& taken = supernodes_[child].nodes;
    nodes.insert(nodes.begin(), taken.begin(), taken.end());
    taken.clear();
    std::vector<int>& list = children_[s];
    list.erase(std::find(list.begin(), list.end(), child));
    list.insert(list.end(), children_[child].begin(), children_[child].end());
    children_[child].clear();
  }

  std::vector<Supernode> inPostorder() {
    std::vector<int> stack, order;
    for (int s = size(children_) - 1; s >= 0; --s)
      if (supernodes_[s].parent == -1) stack.push_back(s);
    while (!stack.empty()) {
      const int s = stack.back();
      stack.pop_back();
      order.push_back(s);
      std::sort(children_[s].begin(), children_[s].end());
      stack.insert(stack.end(), children_[s].begin(), children_[s].end());
    }
    std::reverse(order.begin(), order.end());
    return renumbered(order);
  }

  std::vector<Supernode> renumbered(const std::vector<int>& order) {
    std::vector<Supernode> result(order.size());
    std::vector<int> place(supernodes_.size());
    for (std::size_t k = 0; k < order.size(); ++k) {
      place[order[k]] = static_cast<int>(k);
      result[k] = std::move(supernodes_[order[k]]);
      result[k].parent = -1;
    }
    for (std::size_t k = 0; k < order.size(); ++k)
      for (const int child : children_[order[k]]) result[place[child]].parent = static_cast<int>(k);
    return result;
  }

  static int size(const std::vector<std::vector<int>>& list) { return static_cast<int>(list.size()); }

  std::vector<Supernode> supernodes_;
  std::vector<std::vector<int>> children_;
};

}  // namespace

std::vector<Supernode> amalgamate(std::vector<Supernode> supernodes) {
  return Merger(std::move(supernodes)).run();
}

}  // namespace vibe
