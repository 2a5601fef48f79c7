#pragma once
#include <urdf_model/model.h>
#include <urdf_world/types.h>

#include <memory>
#include <string>

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

}  // namespace vibe
