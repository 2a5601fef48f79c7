#include "solver/coupling_blocks.hpp"

#include <algorithm>

namespace vibe {
namespace {

/// The nodes of a coupling that move, each with its weight.
struct Members {
  Members(const StiffnessCoupling& coupling, const std::vector<char>& fixed) {
    for (std::size_t i = 0; i < coupling.node.size(); ++i) {
      if (coupling.node[i] < 0 || fixed[static_cast<std::size_t>(coupling.node[i])] != 0) continue;
      node[count] = coupling.node[i];
      weight[count++] = static_cast<double>(coupling.weight[i]);
    }
  }
  int count = 0;
  int node[6] = {};
  double weight[6] = {};
};

Eigen::Matrix3d stiffnessOf(const StiffnessCoupling& coupling) {
  const Eigen::Matrix<double, 6, 1> s =
      Eigen::Map<const Eigen::Matrix<float, 6, 1>>(coupling.stiffness.data()).cast<double>();
  Eigen::Matrix3d k;
  k << s[0], s[1], s[2], s[1], s[3], s[4], s[2], s[4], s[5];
  return k;
}

}  // namespace

std::vector<NodePair> coupledPairs(const std::vector<StiffnessCoupling>& couplings, const std::vector<char>& fixed,
                                   const BlockPattern& pattern) {
  std::vector<NodePair> pairs;
  for (const StiffnessCoupling& coupling : couplings) {
    const Members m(coupling, fixed);
    for (int i = 0; i < m.count; ++i)
      for (int j = 0; j < m.count; ++j)
        if (m.node[i] > m.node[j] && pattern.find(m.node[i], m.node[j]) < 0) pairs.push_back({m.node[i], m.node[j]});
  }
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  return pairs;
}

void addCouplings(const std::vector<StiffnessCoupling>& couplings, const std::vector<char>& fixed,
                  BlockMatrix& matrix) {
  for (const StiffnessCoupling& coupling : couplings) {
    const Members m(coupling, fixed);
    const Eigen::Matrix3d k = stiffnessOf(coupling);
    for (int i = 0; i < m.count; ++i)
      for (int j = 0; j <= i; ++j) {
        matrix.add(m.node[i], m.node[j], m.weight[i] * m.weight[j] * k);
        // a node that is named twice
        if (i != j && m.node[i] == m.node[j]) matrix.add(m.node[i], m.node[j], m.weight[i] * m.weight[j] * k);
      }
  }
}

}  // namespace vibe
