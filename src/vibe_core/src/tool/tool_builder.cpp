#include "tool/tool_builder.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "tool/urdf_document.hpp"
#include "vibe_core/program/error.hpp"

namespace vibe {

namespace {

int inputIndex(const std::string& name) {
  const auto it = std::find(kJointNames.begin(), kJointNames.end(), name);
  return it == kJointNames.end() ? -1 : static_cast<int>(it - kJointNames.begin());
}

const std::string kShaftUpDown = "shaft_up_down_";
const std::string kShaftLeftRight = "shaft_left_right_";
constexpr double kSameStation = 1e-6;  // joints of the shaft that are nearer to each other are at one place [m]

// moved by no input: bends under load
bool isShaftJoint(const urdf::Joint& joint) {
  const auto begins = [&](const std::string& with) { return joint.name.compare(0, with.size(), with) == 0; };
  return joint.type == urdf::Joint::REVOLUTE && !joint.mimic && (begins(kShaftUpDown) || begins(kShaftLeftRight));
}

std::string inputList() {
  std::string list;
  for (const char* name : kJointNames) list += (list.empty() ? "" : ", ") + std::string(name);
  return list;
}

}  // namespace

ToolBuilder::ToolBuilder(const UrdfDocument& document, const std::string& place) : document_(&document), place_(place) {
  addTree(*document.model().getRoot());
  checkComplete();
  placeShaft();
}

void ToolBuilder::fail(const char* tag, const std::string& name, const std::string& what) const {
  throw Error(document_->where(tag, name) + ": " + tag + " '" + name + "' " + what + ".");
}

void ToolBuilder::addTree(const urdf::Link& root) {
  struct Visit {
    const urdf::Joint* joint;  // null for the root
    const urdf::Link* link;
    int parent;
  };
  std::vector<Visit> open = {{nullptr, &root, -1}};
  while (!open.empty()) {
    const Visit visit = open.back();
    open.pop_back();
    const int index = addLink(*visit.link);
    if (visit.joint != nullptr) addJoint(*visit.joint, visit.parent, index);
    const auto& children = visit.link->child_joints;
    for (auto it = children.rbegin(); it != children.rend(); ++it) {
      const urdf::LinkConstSharedPtr child = document_->model().getLink((*it)->child_link_name);
      if (child) open.push_back({it->get(), child.get(), index});
    }
  }
}

int ToolBuilder::addLink(const urdf::Link& link) {
  const int index = static_cast<int>(link_names.size());
  if (!link_index_.emplace(link.name, index).second)
    fail("link", link.name, "is the child of two joints; give every link but the root exactly one");
  link_names.push_back(link.name);
  if (std::optional<LinkMesh> mesh = makeMesh(link)) {
    mesh->link = index;
    meshes.push_back(std::move(*mesh));
  }
  try {
    for (ToolShape& shape : makeShapes(link)) {
      shape.link = index;
      shapes.push_back(std::move(shape));
    }
  } catch (const Error& error) {
    fail("link", link.name, error.what());
  }
  return index;
}

void ToolBuilder::addJoint(const urdf::Joint& joint, int parent, int child) {
  ToolJoint result;
  result.name = joint.name;
  result.parent_link = parent;
  result.child_link = child;
  result.origin = toIsometry(joint.parent_to_joint_origin_transform);
  if (!(result.origin.translation().norm() <= 10))
    fail("joint", joint.name, "has an origin that is more than 10 m away; write it in metres");
  if (joint.type == urdf::Joint::FIXED) {
    if (inputIndex(joint.name) >= 0) fail("joint", joint.name, "is an input and cannot be fixed; make it move");
    joints.push_back(result);
    return;
  }
  if (joint.type != urdf::Joint::REVOLUTE && joint.type != urdf::Joint::PRISMATIC)
    fail("joint", joint.name, "is of a type that the tool cannot have; use fixed, revolute or prismatic");
  // A shaft joint is driven by the bend of the shaft, all others by an input, some through a mimic element.
  result.type = joint.type == urdf::Joint::REVOLUTE ? ToolJoint::Type::Revolute : ToolJoint::Type::Prismatic;
  const Eigen::Vector3d axis(joint.axis.x, joint.axis.y, joint.axis.z);
  if (!(axis.norm() > 1e-9) || !std::isfinite(axis.norm()))
    fail("joint", joint.name, "has an axis without direction; write one of length 1");
  result.axis = axis.normalized();
  if (isShaftJoint(joint)) {
    result.station = 0;  // placed when the whole tree is known
    result.direction = joint.name.compare(0, kShaftUpDown.size(), kShaftUpDown) == 0 ? 0 : 1;
    joints.push_back(result);
    return;
  }
  result.input = inputOf(joint);
  if (joint.mimic) {
    result.multiplier = joint.mimic->multiplier;
    result.offset = joint.mimic->offset;
  } else {
    addInput(joint, result.input);
  }
  joints.push_back(result);
}

int ToolBuilder::inputOf(const urdf::Joint& joint) const {
  const int own = inputIndex(joint.name);
  if (!joint.mimic) {
    if (own < 0) fail("joint", joint.name, "moves but nothing drives it; let it mimic one of " + inputList());
    return own;
  }
  if (own >= 0) fail("joint", joint.name, "is an input and cannot mimic another joint; remove its mimic element");
  const int source = inputIndex(joint.mimic->joint_name);
  if (source < 0)
    fail("joint", joint.name,
         "mimics '" + joint.mimic->joint_name + "', which is no input; let it mimic one of " + inputList());
  return source;
}

void ToolBuilder::addInput(const urdf::Joint& joint, int input) {
  if (!joint.limits) fail("joint", joint.name, "has no limit element; write lower, upper, velocity and effort");
  const JointLimits limit = {joint.limits->lower, joint.limits->upper, joint.limits->velocity, joint.limits->effort};
  if (!std::isfinite(limit.lower) || !std::isfinite(limit.upper) || limit.lower >= limit.upper)
    fail("joint", joint.name, "has a lower limit that is not below its upper limit; write finite limits in order");
  if (!std::isfinite(limit.velocity) || limit.velocity <= 0)
    fail("joint", joint.name, "has a velocity limit that is not positive; write the greatest speed in SI units");
  if (!(limit.effort > 0))
    fail("joint", joint.name, "has an effort limit that is not positive; write what a hand applies");
  limits[input] = limit;
  found_[input] = true;
}

// Measures where the joints of the shaft are, with all inputs at 0: the last one along the root's x axis is the end of
// the shaft.
void ToolBuilder::placeShaft() {
  std::vector<Eigen::Isometry3d> pose(link_names.size(), Eigen::Isometry3d::Identity());
  std::vector<double> along;
  for (const ToolJoint& joint : joints) {
    pose[joint.child_link] = pose[joint.parent_link] * joint.origin;
    if (joint.station >= 0) along.push_back(pose[joint.child_link].translation().x());
  }
  if (along.empty()) return;
  shaft_end = *std::max_element(along.begin(), along.end());
  // Joints at one station bend in two directions; roundings of the URDF do not make two stations of it.
  for (double x : along) shaft_stations.push_back(shaft_end - x);
  std::sort(shaft_stations.begin(), shaft_stations.end());
  const auto same = [](double a, double b) { return b - a < kSameStation; };
  shaft_stations.erase(std::unique(shaft_stations.begin(), shaft_stations.end(), same), shaft_stations.end());
  if (shaft_stations.size() > static_cast<std::size_t>(kMaxShaftStations))
    throw Error(place_ + ": the shaft has joints at more than " + std::to_string(kMaxShaftStations) +
                " places; give it fewer.");
  // Each joint finds its station among those that were kept.
  for (ToolJoint& joint : joints) {
    if (joint.station < 0) continue;
    const double behind = shaft_end - pose[joint.child_link].translation().x() - kSameStation;
    const auto at = std::lower_bound(shaft_stations.begin(), shaft_stations.end(), behind);
    joint.station = static_cast<int>(at - shaft_stations.begin());
  }
}

void ToolBuilder::checkComplete() const {
  for (const auto& entry : document_->model().links_)
    if (link_index_.count(entry.first) == 0)
      fail("link", entry.first, "is not connected to the root; remove the ring of joints that it is in");
  for (int i = 0; i < kJointCount; ++i)
    if (!found_[i])
      throw Error(place_ + ": joint '" + kJointNames[i] + "' is missing; the inputs are " + inputList() + ".");
  for (const char* name : {"helix", "needle", "scope_tip", "scope_camera_optical"})
    if (link_index_.count(name) == 0)
      throw Error(place_ + ": link '" + name + "' is missing; add a link of that name.");
}

}  // namespace vibe
