// Messages of a step arrive on two topics in any order: what a trainee perceives in lock-step does not depend on it.
#include "trainee/trainee_topics.hpp"

#include <gtest/gtest.h>

#include <boost/make_shared.hpp>
#include <cstring>
#include <vector>

#include "conversions/conversions.hpp"

namespace vibe::sim::observation_queue_test {
namespace {

vibe_msgs::StepResult::ConstPtr result(int step, bool has_particles = true) {
  const auto message = boost::make_shared<vibe_msgs::StepResult>();
  message->header.stamp = toRosTime(1000 + step);
  message->step = static_cast<std::uint64_t>(step);
  message->has_particles = has_particles;
  return message;
}

/// One point at x = step.
sensor_msgs::PointCloud2::ConstPtr cloud(int step) {
  const auto message = boost::make_shared<sensor_msgs::PointCloud2>();
  message->header.stamp = toRosTime(1000 + step);
  message->width = message->height = 1;
  message->point_step = 12;
  message->data.resize(12);
  const auto x = static_cast<float>(step);
  std::memcpy(message->data.data(), &x, sizeof x);
  for (std::uint32_t axis = 0; axis < 3; ++axis) {
    sensor_msgs::PointField field;
    field.name = std::string(1, static_cast<char>('x' + axis));
    field.offset = 4 * axis;
    field.datatype = sensor_msgs::PointField::FLOAT32;
    message->fields.push_back(field);
  }
  return message;
}

/// Steps and the walls that were seen with them; -1: none.
std::vector<std::pair<int, int>> takeAll(ObservationQueue& queue) {
  std::vector<std::pair<int, int>> taken;
  while (const std::optional<Sight> sight = queue.next()) {
    const std::vector<Eigen::Vector3d>& wall = sight->seen.wall;
    taken.emplace_back(sight->seen.step, wall.empty() ? -1 : static_cast<int>(wall[0].x()));
    EXPECT_EQ(sight->stamp, 1000 + sight->seen.step);
  }
  return taken;
}

using Seen = std::vector<std::pair<int, int>>;

TEST(ObservationQueue, AStepWaitsForItsParticles) {
  ObservationQueue queue(true);
  queue.push(result(0));
  EXPECT_EQ(takeAll(queue), Seen{});
  queue.push(cloud(0));
  EXPECT_EQ(takeAll(queue), (Seen{{0, 0}}));
  queue.push(cloud(1));
  EXPECT_EQ(takeAll(queue), Seen{});
  queue.push(result(1));
  EXPECT_EQ(takeAll(queue), (Seen{{1, 1}}));
  queue.push(result(2, false));
  EXPECT_EQ(takeAll(queue), (Seen{{2, -1}}));
}

TEST(ObservationQueue, WhatIsSeenDoesNotDependOnTheOrderOfArrival) {
  const Seen wanted{{0, 0}, {1, -1}, {2, 2}, {3, 3}};
  for (int order = 0; order < 3; ++order) {
    ObservationQueue queue(true);
    Seen seen;
    const auto take = [&] {
      for (const auto& one : takeAll(queue)) seen.push_back(one);
    };
    for (const int step : {0, 1, 2, 3}) {
      const bool has_particles = step != 1;
      if (order == 0 && has_particles) queue.push(cloud(step)), take();
      queue.push(result(step, has_particles)), take();
      if (order == 1 && has_particles) queue.push(cloud(step)), take();
    }
    if (order == 2) {  // the particles late, all at once
      for (const int step : {0, 2, 3}) queue.push(cloud(step));
      take();
    }
    EXPECT_EQ(seen, wanted) << order;
  }
}

TEST(ObservationQueue, AStepWhoseParticlesWereMissedIsLeftOut) {
  ObservationQueue queue(true);
  queue.push(result(4));
  queue.push(cloud(2));
  EXPECT_EQ(takeAll(queue), Seen{});
  queue.push(result(5));
  queue.push(cloud(5));
  EXPECT_EQ(takeAll(queue), (Seen{{5, 5}}));
}

TEST(ObservationQueue, InRealTimeTheNewestCounts) {
  ObservationQueue queue(false);
  queue.push(result(0));
  EXPECT_EQ(takeAll(queue), (Seen{{0, -1}}));
  queue.push(cloud(1));
  queue.push(cloud(2));
  queue.push(result(1));
  queue.push(result(2));
  EXPECT_EQ(takeAll(queue), (Seen{{1, 2}, {2, -1}}));
}

}  // namespace
}  // namespace vibe::sim::observation_queue_test
