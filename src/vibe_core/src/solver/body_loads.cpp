#include "vibe_core/solver/body_loads.hpp"

#include <algorithm>

namespace vibe {

void BodyLoads::clear() {
  constraints.clear();
  contacts.clear();
  attachments.clear();
  threads.clear();
  gas = GasLoad();
  tool_yield = ToolYield();
  contraction = nullptr;
  stress = nullptr;
  stress_work = 0;
  driven = false;
  held_still = false;
  extra = nullptr;
  couplings.clear();
}

void BodyLoads::findNodes(std::vector<int>& all) const {
  all.clear();
  for (const LinearConstraint& constraint : constraints)
    all.insert(all.end(), constraint.node.begin(), constraint.node.end());
  for (const ContactConstraint& contact : contacts)
    all.insert(all.end(), contact.point.node.begin(), contact.point.node.begin() + contact.point.count);
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
}

std::size_t BodyLoads::addPoint(const std::vector<int>& node, const std::vector<double>& weight,
                                const Eigen::Vector3d& target, double compliance) {
  const std::size_t first = constraints.size();
  for (int k = 0; k < 3; ++k) {
    LinearConstraint& constraint = constraints.add();
    constraint.node = node;
    constraint.coefficient.clear();
    for (double w : weight) constraint.coefficient.emplace_back(w * Eigen::Vector3d::Unit(k));
    constraint.target = target[k];
    constraint.compliance = compliance;
    constraint.yield.setZero();
    constraint.force = 0;
  }
  return first;
}

double BodyLoads::pointWork(std::size_t first) const {
  return constraints[first].work + constraints[first + 1].work + constraints[first + 2].work;
}

Eigen::Vector3d BodyLoads::pointForce(std::size_t first) const {
  return {constraints[first].force, constraints[first + 1].force, constraints[first + 2].force};
}

}  // namespace vibe
