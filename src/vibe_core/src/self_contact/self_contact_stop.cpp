// How walls are stopped on their paths at the end of a step.
#include <algorithm>
#include <array>
#include <cmath>

#include "self_contact/self_contact.hpp"
#include "self_contact/self_contact_memory.hpp"

namespace vibe {

constexpr double kSquaredRounding = 1e-12;  // of a speed in single precision: the ratio below stays finite

const std::vector<int>& SelfContact::resolvePenetrations(const MotionView& motion, double step) {
  stopped_.clear();
  SelfContactMemory& m = *memory_;
  if (!startPaths(motion) || !shortenPaths()) return stopped_;
  // Only nodes whose path was shortened lose speed; all others keep every bit of their motion.
  for (std::size_t i = 0; i < m.position.size(); ++i) {
    if (m.move[i] == m.whole[i]) continue;
    stop(motion, static_cast<int>(i), m.position[i] + m.move[i], step);
    stopped_.push_back(static_cast<int>(i));
  }
  return stopped_;
}

// Finds the pairs of triangles that may meet, and sets positions and moves if there are some.
// @returns false if nothing can meet, or the paths are not finite
bool SelfContact::startPaths(const MotionView& motion) {
  SelfContactMemory& m = *memory_;
  const std::array<const double*, 3> end{motion.x[0], motion.x[1], motion.x[2]};
  found_ = found_ && m.search.adapt(SelfContactMemory::view(m.start), end, searchDistance());
  if (!found_ || m.search.meetings().empty()) return false;
  for (std::size_t i = 0; i < m.position.size(); ++i) {
    m.position[i] = m.at(static_cast<int>(i));
    m.whole[i] = Eigen::Vector3d(end[0][i], end[1][i], end[2][i]) - m.position[i];
    m.move[i] = m.whole[i];
  }
  return true;
}

// Paths that become shorter by different parts may meet others: they are searched again until nothing changes.
// @returns whether any was shortened
bool SelfContact::shortenPaths() {
  SelfContactMemory& m = *memory_;
  for (int search = 0; search < policy_.path_searches; ++search) {
    const bool stop = search >= policy_.path_patience;
    if (!m.paths.shorten(m.position, m.search.meetings(), stop, m.move)) return search > 0;
    spreadStops();
    for (std::size_t i = 0; i < m.move.size(); ++i)
      for (std::size_t k = 0; k < 3; ++k) m.end[k][i] = m.position[i][k] + m.move[i][k];
    m.search.adapt(SelfContactMemory::view(m.start), SelfContactMemory::view(m.end), searchDistance());
  }
  // At the start of the step nothing crosses, so that staying there is always possible.
  std::fill(m.move.begin(), m.move.end(), Eigen::Vector3d::Zero());
  return true;
}

// Nodes around one that stops slow down, so that its triangles are not torn apart: along each edge the faster node may
// run ahead of the slower one by stop_stretch of the length of the edge.
void SelfContact::spreadStops() {
  SelfContactMemory& m = *memory_;
  // What is left of each way is kept as a part of it, because the direction stays.
  for (std::size_t i = 0; i < m.move.size(); ++i) {
    const double whole2 = m.whole[i].squaredNorm();
    m.part[i] = whole2 > 0 ? m.move[i].dot(m.whole[i]) / whole2 : 1;
    m.length[i] = std::sqrt(whole2);
  }
  // Slowing one node down may ask the same of its neighbours; sweeps end where nothing changes.
  bool changed = true;
  for (int sweep = 0; sweep < policy_.stop_sweeps && changed; ++sweep) {
    changed = false;
    for (const auto& n : rest_.triangles)
      for (int k = 0; k < 3; ++k) {
        int slow = n[k], fast = n[(k + 1) % 3];
        if (m.part[slow] > m.part[fast]) std::swap(slow, fast);
        const double late = m.length[fast] * (m.part[fast] - m.part[slow]);
        const double allowed = policy_.stop_stretch * (m.position[fast] - m.position[slow]).norm();
        if (late <= allowed * (1 + policy_.stop_fewer)) continue;
        m.part[fast] = m.part[slow] + allowed / m.length[fast];
        m.move[fast] = m.part[fast] * m.whole[fast];
        changed = true;
      }
  }
}

// Ends the motion of a node at a point before its end, with the speed of that path but no more than it had.
void SelfContact::stop(const MotionView& motion, int node, const Eigen::Vector3d& end, double step) const {
  double before2 = 0;
  const Eigen::Vector3d speed = (end - memory_->at(node)) / step;
  for (int k = 0; k < 3; ++k) before2 += motion.v[k][node] * motion.v[k][node];
  const double part = std::min(1.0, std::sqrt(before2 / std::max(speed.squaredNorm(), before2 * kSquaredRounding)));
  for (int k = 0; k < 3; ++k) {
    motion.x[k][node] = end[k];
    motion.v[k][node] = before2 > 0 ? part * speed[k] : 0;
    motion.a[k][node] = 0;  // the impulse of the stop is in no force
  }
}

}  // namespace vibe
