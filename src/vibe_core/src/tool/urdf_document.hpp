#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <urdf_model/link.h>
#include <urdf_model/model.h>
#include <urdf_world/types.h>

#include "vibe_core/tool/tool_model.hpp"

namespace tinyxml2 {
class XMLDocument;
}

namespace vibe {

/// A URDF parsed by urdfdom. tinyxml2 parses the same text to provide line numbers for errors.
class UrdfDocument {
 public:
  /// @param text   the URDF
  /// @param place  name used in error messages, e.g. the file name
  /// @throws Error if urdfdom does not accept it; nothing is printed
  UrdfDocument(const std::string& text, const std::string& place);
  ~UrdfDocument();
  UrdfDocument(const UrdfDocument&) = delete;
  UrdfDocument& operator=(const UrdfDocument&) = delete;

  const urdf::ModelInterface& model() const { return *model_; }

  /// "place:line" of the element <tag name="...">, or "place" if the text has none.
  std::string where(const std::string& tag, const std::string& name) const;

 private:
  std::string whereNamedIn(const std::string& message) const;

  std::unique_ptr<tinyxml2::XMLDocument> lines_;
  std::string place_;
  urdf::ModelInterfaceSharedPtr model_;
};

/// Position and rotation of a URDF <origin>.
Eigen::Isometry3d toIsometry(const urdf::Pose& pose);

/// The mesh for the picture of a link, if its first visual is one; the caller sets LinkMesh::link.
std::optional<LinkMesh> makeMesh(const urdf::Link& link);

/// The collision shapes of a link as Bullet shapes without rounding margin; the caller sets ToolShape::link. A cylinder
/// with a sphere of the same radius at each end becomes one capsule. The surface is the same, but a point inside is
/// then pushed out sideways and never through the end of the cylinder into the sphere.
/// @throws Error with the remainder of a sentence that begins with the link: the error and the remedy, no full stop
std::vector<ToolShape> makeShapes(const urdf::Link& link);

}  // namespace vibe
