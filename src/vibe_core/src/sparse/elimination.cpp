#include "sparse/elimination.hpp"

#include <algorithm>
#include <iterator>

namespace vibe {

namespace {

std::vector<int> inverse(const std::vector<int>& order) {
  std::vector<int> place(order.size());
  for (std::size_t k = 0; k < order.size(); ++k) place[order[k]] = static_cast<int>(k);
  return place;
}

// for each node in elimination order, the earlier nodes coupled with it
std::vector<std::vector<int>> earlierNeighbours(const BlockPattern& pattern, const std::vector<int>& place) {
  std::vector<std::vector<int>> earlier(pattern.size);
  for (int i = 0; i < pattern.size; ++i)
    for (int k = pattern.start[i]; k < pattern.start[i + 1]; ++k) {
      const int a = place[i], b = place[pattern.column[k]];
      earlier[std::max(a, b)].push_back(std::min(a, b));
    }
  return earlier;
}

// Liu, "The role of elimination trees in sparse factorization", SIAM J. Matrix Anal. Appl. 11 (1990), algorithm 4.2
std::vector<int> eliminationTree(const std::vector<std::vector<int>>& earlier) {
  const int size = static_cast<int>(earlier.size());
  std::vector<int> parent(size, -1), ancestor(size, -1);
  for (int i = 0; i < size; ++i)
    for (int k : earlier[i])
      while (k != -1 && k != i) {
        const int next = ancestor[k];
        ancestor[k] = i;
        if (next == -1) parent[k] = i;
        k = next;
      }
  return parent;
}

std::vector<int> postorder(const std::vector<int>& parent) {
  const int size = static_cast<int>(parent.size());
  std::vector<std::vector<int>> children(size);
  std::vector<int> stack, visited;
  for (int k = size - 1; k >= 0; --k)
    if (parent[k] == -1)
      stack.push_back(k);
    else
      children[parent[k]].push_back(k);
  while (!stack.empty()) {  // parents before children, reversed afterwards
    const int k = stack.back();
    stack.pop_back();
    visited.push_back(k);
    stack.insert(stack.end(), children[k].rbegin(), children[k].rend());
  }
  std::reverse(visited.begin(), visited.end());
  return visited;
}

// rows below the diagonal of each column of the factor
std::vector<std::vector<int>> factorColumns(const std::vector<std::vector<int>>& earlier,
                                            const std::vector<int>& parent) {
  const int size = static_cast<int>(earlier.size());
  std::vector<std::vector<int>> rows(size);
  for (int i = 0; i < size; ++i)
    for (const int k : earlier[i]) rows[k].push_back(i);  // ascending, as i ascends
  std::vector<int> merged;
  for (int k = 0; k < size; ++k) {
    if (parent[k] == -1) continue;
    std::vector<int>& above = rows[parent[k]];
    merged.clear();
    std::set_union(above.begin(), above.end(), rows[k].begin() + 1, rows[k].end(), std::back_inserter(merged));
    above = merged;
  }
  return rows;
}

}  // namespace

BlockPattern extended(const BlockPattern& pattern, const std::vector<NodePair>& pairs) {
  BlockPattern out;
  out.size = pattern.size;
  out.start.assign(1, 0);
  auto pair = pairs.begin();
  for (int i = 0; i < pattern.size; ++i) {
    const auto first = static_cast<std::ptrdiff_t>(out.column.size());
    out.column.insert(out.column.end(), pattern.column.begin() + pattern.start[i],
                      pattern.column.begin() + pattern.start[i + 1]);
    for (; pair != pairs.end() && pair->row == i; ++pair) out.column.push_back(pair->column);
    std::sort(out.column.begin() + first, out.column.end());
    out.start.push_back(static_cast<int>(out.column.size()));
  }
  return out;
}

std::vector<Supernode> symbolicFactor(const BlockPattern& pattern, std::vector<int> order) {
  // a postorder of the tree is an equivalent order in which every supernode is a contiguous run of columns
  const std::vector<int> turned = postorder(eliminationTree(earlierNeighbours(pattern, inverse(order))));
  std::vector<int> sorted(order.size());
  for (std::size_t k = 0; k < order.size(); ++k) sorted[k] = order[turned[k]];
  order = sorted;
  const std::vector<std::vector<int>> earlier = earlierNeighbours(pattern, inverse(order));
  const std::vector<int> parent = eliminationTree(earlier);
  const std::vector<std::vector<int>> rows = factorColumns(earlier, parent);

  std::vector<Supernode> supernodes;
  std::vector<int> holder(order.size()), last_column;
  for (int k = 0; k < static_cast<int>(order.size()); ++k) {
    const bool continues = k > 0 && parent[k - 1] == k && rows[k - 1].size() == rows[k].size() + 1;
    if (!continues) {
      supernodes.emplace_back();
      last_column.push_back(k);
    }
    supernodes.back().nodes.push_back(order[k]);
    last_column.back() = k;
    holder[k] = static_cast<int>(supernodes.size()) - 1;
  }
  for (std::size_t s = 0; s < supernodes.size(); ++s) {
    const int last = last_column[s];
    if (parent[last] != -1) supernodes[s].parent = holder[parent[last]];
    for (const int row : rows[last]) supernodes[s].rows.push_back(order[row]);
  }
  return supernodes;
}

// Measured on the AVX2 path: the entries of a panel stream at about kNumberCost cycles each (both passes). Every row of
// a supernode is gathered and scattered once. Every tile of 8 columns and every supernode has a fixed overhead.
double solveCost(int nodes, int rows) {
  constexpr double kNumberCost = 0.25, kRowCost = 2.5, kTileCost = 30, kSupernodeCost = 120;
  const double columns = 3.0 * nodes, all_rows = columns + 3.0 * rows;
  const double numbers = columns * (all_rows + 4 - columns / 2);
  return kNumberCost * numbers + kRowCost * all_rows + kTileCost * (columns / 8 + 1) + kSupernodeCost;
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
