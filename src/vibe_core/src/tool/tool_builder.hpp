#pragma once
#include <Eigen/Geometry>
#include <array>
#include <map>
#include <string>
#include <vector>

#include "tool/urdf_document.hpp"
#include "vibe_core/tool/tool_model.hpp"

namespace vibe {

/// Converts a URDF into the parts of a ToolModel, parent links first. Contains all checks of ToolModel::fromUrdf that
/// urdfdom does not make.
class ToolBuilder {
 public:
  /// @throws Error
  ToolBuilder(const UrdfDocument& document, const std::string& place);

  std::vector<std::string> link_names;
  std::vector<ToolJoint> joints;
  std::vector<ToolShape> shapes;
  std::vector<LinkMesh> meshes;
  std::array<JointLimits, kJointCount> limits{};
  std::vector<double> shaft_stations;  ///< see ToolModel::shaftStations()
  double shaft_end = 0;                ///< see ToolModel::freeLength()

 private:
  void addTree(const urdf::Link& root);
  int addLink(const urdf::Link& link);
  void addJoint(const urdf::Joint& joint, int parent, int child);
  void addInput(const urdf::Joint& joint, int input);
  int inputOf(const urdf::Joint& joint) const;
  void placeShaft();
  void checkComplete() const;
  [[noreturn]] void fail(const char* tag, const std::string& name, const std::string& what) const;

  const UrdfDocument* document_;
  std::string place_;
  std::map<std::string, int> link_index_;
  std::array<bool, kJointCount> found_{};
};

}  // namespace vibe
