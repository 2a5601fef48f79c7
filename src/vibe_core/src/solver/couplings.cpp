#include "solver/couplings.hpp"

#include <algorithm>

#include "vibe_core/solver/step_policy.hpp"

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

namespace {

bool setNodes(const AttachmentPoint& from, const AttachmentPoint& to, StiffnessCoupling& coupling) {
  if (from.node.size() + to.node.size() > coupling.node.size()) return false;
  std::size_t n = 0;
  for (const AttachmentPoint* point : {&from, &to})
    for (std::size_t i = 0; i < point->node.size(); ++i, ++n) {
      coupling.node[n] = point->node[i];
      coupling.weight[n] = static_cast<float>((point == &from ? 1 : -1) * point->weight[i]);
    }
  return true;
}

Eigen::Vector3d runOf(const StiffnessCoupling& coupling, const double* positions4) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();  // from the second point to the first
  for (std::size_t i = 0; i < coupling.node.size(); ++i)
    for (int k = 0; k < 3 && coupling.node[i] >= 0; ++k)
      sum[k] += static_cast<double>(coupling.weight[i]) * positions4[4 * coupling.node[i] + k];
  return -sum;
}

void setAcross(const Eigen::Vector3d& along, double stiffness, StiffnessCoupling& coupling) {
  std::size_t entry = 0;
  for (int i = 0; i < 3; ++i)
    for (int j = i; j < 3; ++j)
      coupling.stiffness[entry++] = static_cast<float>(stiffness * ((i == j ? 1 : 0) - along[i] * along[j]));
}

// Half of the trace: k (I - t tT) has it twice.
double stiffnessAcross(const StiffnessCoupling& coupling) {
  return 0.5 * static_cast<double>(coupling.stiffness[0] + coupling.stiffness[3] + coupling.stiffness[5]);
}

// In the list from `hint` on, and around its end; the order of segments hardly changes from factor to factor.
double stiffnessIn(const std::vector<StiffnessCoupling>& list, const StiffnessCoupling& wanted, std::size_t& hint) {
  for (std::size_t k = 0; k < list.size(); ++k) {
    const std::size_t i = (hint + k) % list.size();
    if (list[i].node != wanted.node || list[i].weight != wanted.weight) continue;
    hint = i + 1;
    return stiffnessAcross(list[i]);
  }
  return 0;
}

}  // namespace

double turnCompliance(double length, double tension) {
  return std::max(length, kMinThread) / std::max(tension, stepPolicy().slack_tension);
}

Eigen::Vector3d segmentDirection(const Eigen::Vector3d& between_points) {
  const double length = between_points.norm();
  return length > stepPolicy().shortest_segment ? Eigen::Vector3d(between_points / length)
                                                : Eigen::Vector3d(Eigen::Vector3d::UnitX());
}

void addThreadCouplings(const BodyLoads& loads, const double* positions4, double gain,
                        std::vector<StiffnessCoupling>& couplings) {
  for (const ThreadLoad& thread : loads.threads)
    for (std::size_t k = 0; k < thread.length.size(); ++k) {
      const auto first = static_cast<std::size_t>(thread.first_attachment) + k;
      StiffnessCoupling coupling;
      if (!setNodes(loads.attachments[first], loads.attachments[first + 1], coupling)) continue;
      const Eigen::Vector3d run = runOf(coupling, positions4);
      const double stiffness = 1 / (gain * turnCompliance(run.norm(), thread.tension[k]));
      if (stiffness < stepPolicy().soft_turn) continue;
      setAcross(segmentDirection(run), stiffness, coupling);
      couplings.push_back(coupling);
    }
}

void findMissingTurns(const BodyLoads& loads, const std::vector<StiffnessCoupling>& in_factor, ConstraintRows& rows) {
  std::size_t hint = 0;
  for (ThreadRows& thread : rows.threads)
    for (int k = 0; k < thread.count(); ++k) {
      SegmentRows& segment = thread.segments[static_cast<std::size_t>(k)];
      const auto first = static_cast<std::size_t>(thread.first_attachment + k);
      StiffnessCoupling coupling;
      const double wanted = 1 / segment.turn_compliance;
      double has = 0;
      if (wanted > stepPolicy().soft_turn && setNodes(loads.attachments[first], loads.attachments[first + 1], coupling))
        has = stiffnessIn(in_factor, coupling, hint);
      const double missing = wanted - has;
      segment.turn_missing =
          missing > std::max(stepPolicy().soft_turn, stepPolicy().missing_turn * wanted) ? 1 / missing : 0;
    }
}

}  // namespace vibe
