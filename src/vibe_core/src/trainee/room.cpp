#include "trainee/room.hpp"

#include "tool_contact/surface_contacts.hpp"
#include "tool_contact/tool_approach.hpp"
#include "tool_contact/tool_collision.hpp"

namespace vibe {

// Each particle in the tool counts with its part of the wall and its depth.
double overlapWithWall(const Model& model, const std::vector<Eigen::Vector3d>& wall, const TraineeHand::Joints& joints,
                       const std::function<bool(int)>& may_touch) {
  std::vector<Eigen::Isometry3d> poses;
  model.tool->forwardKinematics(joints, poses);
  for (Eigen::Isometry3d& pose : poses) pose = model.tool_base * pose;
  std::vector<double> x, y, z;
  for (const Eigen::Vector3d& p : wall) x.push_back(p.x()), y.push_back(p.y()), z.push_back(p.z());
  ToolCollision collision(*model.tool);
  collision.findCandidates(poses, x.data(), y.data(), z.data(), static_cast<int>(wall.size()), 0);
  const std::vector<char> passable = passableVertices(model.organ), on_tip = shapesOnTip(*model.tool);
  double sum = 0;
  forEachDeepest(collision.findContacts(poses, x.data(), y.data(), z.data(), 0), [&](const Contact& contact) {
    if (passable[contact.particle] != 0) return;
    if (on_tip[contact.shape] != 0 && may_touch && may_touch(contact.particle)) return;
    sum -= contact.distance * model.area[contact.particle];
  });
  return sum;
}

}  // namespace vibe
