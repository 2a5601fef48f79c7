#pragma once
#include <vibe_msgs/SutureArray.h>
#include <vibe_msgs/TissueTopology.h>

#include <vector>

namespace vibe::graphics {

// Messages with sutures as a simulator sends them, for tests.

inline geometry_msgs::Point pointOf(double x, double y, double z) {
  geometry_msgs::Point point;
  point.x = x, point.y = y, point.z = z;
  return point;
}

/// A U of six bites with a corner at bites 2 and 3; the first piece is slack with a point in its middle.
inline vibe_msgs::Suture uSuture() {
  vibe_msgs::Suture suture;
  const double places[6][2] = {{0, 0.03}, {0, 0.015}, {0, 0}, {0.015, 0}, {0.015, 0.015}, {0.015, 0.03}};
  for (const auto& place : places) {
    vibe_msgs::Bite bite;
    bite.position = pointOf(-0.04, place[0], place[1]);
    bite.wall = vibe_msgs::TissueTopology::WALL_POSTERIOR;
    bite.full_thickness = suture.bites.size() != 1;
    suture.bites.push_back(bite);
    suture.taken.push_back(bite.position);
    suture.thread_offsets.push_back(static_cast<std::uint32_t>(suture.thread.size()));
    suture.thread.push_back(bite.position);
    if (suture.bites.size() == 1) suture.thread.push_back(pointOf(-0.043, 0, 0.0225));
  }
  suture.length = {0.0165, 0.015, 0.015, 0.015, 0.015};
  suture.tension = {0, 0.5, 1, 1.5, 2};
  suture.stage = vibe_msgs::Suture::CINCHED;
  suture.technique = vibe_msgs::Suture::TECHNIQUE_U;
  suture.technique_name = "u";
  suture.technique_margin = 0.97;
  suture.transitions = {1, 2};
  suture.has_t_tag = suture.has_cinch = true;
  suture.t_tag = suture.bites.back().position;
  suture.cinch = suture.bites.front().position;
  return suture;
}

inline vibe_msgs::Bleeding bleedingAt(int suture, int bite, bool brisk) {
  vibe_msgs::Bleeding bleeding;
  bleeding.suture = suture, bleeding.bite = bite, bleeding.brisk = brisk;
  bleeding.position = pointOf(-0.04, 0, 0.015);
  bleeding.begin = 10;
  bleeding.rate = brisk ? 2.5e-7 : 1e-8;
  bleeding.amount = 1e-7;
  return bleeding;
}

/// The U, an open thread of one bite, and three places that bleed.
inline vibe_msgs::SutureArray session() {
  vibe_msgs::SutureArray message;
  message.header.frame_id = "world";
  message.header.stamp = ros::Time(25.0);
  message.sutures = {uSuture(), vibe_msgs::Suture()};
  message.sutures[1].bites.push_back(message.sutures[0].bites[0]);
  message.bleedings = {bleedingAt(0, 1, false), bleedingAt(1, 0, true), bleedingAt(0, -1, false)};
  return message;
}

}  // namespace vibe::graphics
