#include "contact/needle_linkage.hpp"

#include <algorithm>
#include <cmath>

#include "common/elementary.hpp"

namespace vibe {
namespace {

// In the frame of the link that carries arm and needle, all in the plane across the axis.
struct Bars {
  Eigen::Vector3d axis;       // unit
  Eigen::Vector3d hinge;      // [m]
  Eigen::Vector3d arm, hook;  // with the arm open: from the hinge and from the needle's point to the pin [m]
  Eigen::Vector3d open, way;  // of the needle's point: with the arm open, and per metre of needle_driver

  Eigen::Vector3d toPoint(double driver) const { return flat(open + driver * way - hinge); }
  Eigen::Vector3d flat(const Eigen::Vector3d& v) const { return v - axis.dot(v) * axis; }
  double turn(const Eigen::Vector3d& from, const Eigen::Vector3d& to) const {
    return math::atan2(axis.dot(from.cross(to)), from.dot(to));
  }
};

std::optional<Bars> barsOf(const ToolModel& tool) {
  const ToolJoint *hinge = findJoint(tool, "needle_arm_hinge"), *arm_pin = findJoint(tool, "needle_arm_pin_mount"),
                  *needle = findJoint(tool, "needle_driver"), *turn = findJoint(tool, "needle_hook_turn"),
                  *hook_pin = findJoint(tool, "needle_hook_pin_mount");
  for (const ToolJoint* joint : {hinge, arm_pin, needle, turn, hook_pin})
    if (joint == nullptr) return std::nullopt;
  if (hinge->parent_link != needle->parent_link) return std::nullopt;
  Bars bars;
  bars.axis = hinge->origin.linear() * hinge->axis;
  bars.hinge = hinge->origin.translation();
  bars.arm = bars.flat(hinge->origin.linear() * arm_pin->origin.translation());
  bars.hook = bars.flat(needle->origin.linear() * turn->origin.linear() * hook_pin->origin.translation());
  bars.open = needle->origin.translation();
  bars.way = needle->origin.linear() * needle->axis;
  return bars;
}

}  // namespace

const ToolJoint* findJoint(const ToolModel& tool, const std::string& name) {
  const auto& joints = tool.joints();
  const auto found = std::find_if(joints.begin(), joints.end(), [&](const ToolJoint& j) { return j.name == name; });
  return found == joints.end() ? nullptr : &*found;
}

std::optional<LinkageTurns> needleLinkage(const ToolModel& tool, double driver) {
  const std::optional<Bars> bars = barsOf(tool);
  if (!bars) return std::nullopt;
  const Eigen::Vector3d to_point = bars->toPoint(driver);
  const double distance = to_point.norm();
  if (!(distance > 0)) return std::nullopt;
  const double arm2 = bars->arm.squaredNorm(), hook2 = bars->hook.squaredNorm();
  const double arm_length = std::sqrt(arm2);
  const double along = std::clamp((arm2 + distance * distance - hook2) / (2 * distance), -arm_length, arm_length);
  const double side = bars->axis.dot(bars->toPoint(0).cross(bars->arm)) < 0 ? -1 : 1;
  const double beside = side * std::sqrt(std::max(0.0, arm2 - along * along));
  const Eigen::Vector3d ahead = to_point / distance;
  const Eigen::Vector3d arm = along * ahead + beside * bars->axis.cross(ahead);
  return LinkageTurns{bars->turn(bars->arm, arm), bars->turn(bars->hook, arm - to_point)};
}

}  // namespace vibe
