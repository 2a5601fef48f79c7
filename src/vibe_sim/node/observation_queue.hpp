#pragma once
#include <sensor_msgs/PointCloud2.h>
#include <vibe_msgs/StepResult.h>

#include <deque>
#include <optional>

#include "vibe_core/trainee/observation.hpp"

namespace vibe::sim {

/// What a trainee perceived after one step, and when.
struct Sight {
  Observation seen;
  std::int64_t stamp = 0;      ///< of the end of the step [ns]
  std::uint32_t revision = 0;  ///< of the topology
};

/// Puts together the messages of a step, which arrive on two topics in any order.
class ObservationQueue {
 public:
  /// @param complete  wait for the particles of each step that has some, so that what is perceived does not depend on
  ///                  when messages arrive; else use the newest
  explicit ObservationQueue(bool complete) : complete_(complete) {}

  void push(const vibe_msgs::StepResult::ConstPtr& result);
  void push(const sensor_msgs::PointCloud2::ConstPtr& cloud);

  /// The next step in order; empty: not everything of it is here.
  /// @throws Error if the cloud cannot be read; it is dropped
  std::optional<Sight> next();

 private:
  bool complete_;
  std::deque<vibe_msgs::StepResult::ConstPtr> results_;
  std::deque<sensor_msgs::PointCloud2::ConstPtr> clouds_;

  bool findCloud(const vibe_msgs::StepResult& result);
  std::vector<Eigen::Vector3d> takeWall();
};

}  // namespace vibe::sim
