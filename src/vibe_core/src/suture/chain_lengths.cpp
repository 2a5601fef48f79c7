#include "suture/chain_lengths.hpp"

namespace vibe::detail {

namespace {

constexpr int kMaxPasses = 200;
/// Tolerance of the end position as a fraction of the thread length.
constexpr double kReached = 1e-5;

/// Moves node `to` to one link length from node `from`.
void update(double link, int from, int to, Eigen::Matrix3Xd& position) {
  const Eigen::Vector3d way = position.col(to) - position.col(from);
  const double distance = way.norm();
  const Eigen::Vector3d direction =
      distance > 1e-9 * link ? Eigen::Vector3d(way / distance) : Eigen::Vector3d(Eigen::Vector3d::Unit(to % 3));
  position.col(to) = position.col(from) + link * direction;
}

void followFirst(const HangingThreadModel& model, Eigen::Matrix3Xd& position) {
  for (int j = 1; j <= model.links; ++j) update(model.linkLength(), j - 1, j, position);
}

void followLast(const HangingThreadModel& model, Eigen::Matrix3Xd& position) {
  for (int j = model.links - 1; j >= 0; --j) update(model.linkLength(), j + 1, j, position);
}

}  // namespace

void restoreLengths(const HangingThreadModel& model, const ThreadEnds& ends, Eigen::Matrix3Xd& position) {
  const int last = model.links;
  if (ends.first_held) position.col(0) = ends.first;
  if (ends.last_held) position.col(last) = ends.last;
  if (!ends.last_held) return followFirst(model, position);
  if (!ends.first_held) return followLast(model, position);
  const Eigen::Vector3d between = ends.last - ends.first;
  if (between.norm() >= model.length) {
    for (int j = 0; j <= last; ++j) position.col(j) = ends.first + between * (static_cast<double>(j) / last);
    return;
  }
  for (int pass = 0; pass < kMaxPasses; ++pass) {
    followLast(model, position);
    position.col(0) = ends.first;
    followFirst(model, position);
    const double miss = (position.col(last) - ends.last).norm();
    position.col(last) = ends.last;
    if (miss <= kReached * model.length) return;
  }
}

}  // namespace vibe::detail
