#include "tool/urdf_document.hpp"

#include <cmath>
#include <mutex>

#include <BulletCollision/CollisionShapes/btBoxShape.h>
#include <BulletCollision/CollisionShapes/btCapsuleShape.h>
#include <BulletCollision/CollisionShapes/btCylinderShape.h>
#include <BulletCollision/CollisionShapes/btSphereShape.h>
#include <console_bridge/console.h>
#include <tinyxml2.h>
#include <urdf_parser/urdf_parser.h>

#include "vibe_core/program/error.hpp"

namespace vibe {

namespace {

// urdfdom reports errors through the process-wide console_bridge; this handler stores the first one instead of printing
// it
class LogCatcher : public console_bridge::OutputHandler {
 public:
  LogCatcher() : previous_(console_bridge::getOutputHandler()) { console_bridge::useOutputHandler(this); }
  ~LogCatcher() override { console_bridge::useOutputHandler(previous_); }
  LogCatcher(const LogCatcher&) = delete;
  LogCatcher& operator=(const LogCatcher&) = delete;

  void log(const std::string& text, console_bridge::LogLevel level, const char*, int) override {
    if (first_error_.empty() && level >= console_bridge::CONSOLE_BRIDGE_LOG_ERROR) first_error_ = text;
  }
  const std::string& firstError() const { return first_error_; }

 private:
  console_bridge::OutputHandler* previous_;
  std::string first_error_;
};

// one line without a full stop at its end, for use inside a sentence
std::string asClause(std::string text) {
  for (char& c : text)
    if (static_cast<unsigned char>(c) < ' ') c = ' ';
  while (!text.empty() && (text.back() == '.' || text.back() == ' ')) text.pop_back();
  return text;
}

urdf::ModelInterfaceSharedPtr parseQuietly(const std::string& text, std::string& reason) {
  static std::mutex one_at_a_time;  // the whole process shares the log handler
  const std::lock_guard<std::mutex> lock(one_at_a_time);
  LogCatcher catcher;
  urdf::ModelInterfaceSharedPtr model;
  try {
    model = urdf::parseURDF(text);
  } catch (const std::exception& error) {
    reason = asClause(error.what());
  }
  if (reason.empty()) reason = asClause(catcher.firstError());
  if (reason.empty()) reason = "urdfdom gives no reason";
  return model;
}

// the first element <tag name="..."> among `element`, its following siblings and their descendants; null if there is
// none
const tinyxml2::XMLElement* findNamed(const tinyxml2::XMLElement* element, const std::string& tag,
                                      const std::string& name) {
  for (; element != nullptr; element = element->NextSiblingElement()) {
    if (tag == element->Name() && element->Attribute("name", name.c_str()) != nullptr) return element;
    if (const auto* inside = findNamed(element->FirstChildElement(), tag, name)) return inside;
  }
  return nullptr;
}

}  // namespace

UrdfDocument::UrdfDocument(const std::string& text, const std::string& place)
    : lines_(std::make_unique<tinyxml2::XMLDocument>()), place_(place) {
  lines_->Parse(text.c_str(), text.size());
  std::string reason;
  model_ = parseQuietly(text, reason);
  if (model_ && model_->getRoot()) return;
  const bool has_tags = text.find('<') != std::string::npos;
  if (has_tags && lines_->Error())
    throw Error(place + ":" + std::to_string(lines_->ErrorLineNum()) + ": the XML of this URDF is broken here (" +
                reason + "); close what is open and quote every value.");
  throw Error(whereNamedIn(reason) + ": this is not a valid URDF (" + reason + "); correct that element.");
}

// urdfdom writes names in square brackets
std::string UrdfDocument::whereNamedIn(const std::string& message) const {
  std::size_t begin = message.find('[');
  for (; begin != std::string::npos; begin = message.find('[', begin + 1)) {
    const std::size_t end = message.find(']', begin);
    if (end == std::string::npos) break;
    const std::string name = message.substr(begin + 1, end - begin - 1);
    for (const char* tag : {"joint", "link", "material"})
      if (std::string place = where(tag, name); place != place_) return place;
  }
  return place_;
}

UrdfDocument::~UrdfDocument() {
  // a cycle of joints is a cycle of shared pointers, which would never be freed
  for (const auto& entry : model_->links_) {
    entry.second->child_links.clear();
    entry.second->child_joints.clear();
  }
}

std::string UrdfDocument::where(const std::string& tag, const std::string& name) const {
  const tinyxml2::XMLElement* element = findNamed(lines_->RootElement(), tag, name);
  return element == nullptr ? place_ : place_ + ":" + std::to_string(element->GetLineNum());
}

namespace {

using ShapePointer = std::shared_ptr<const btConvexShape>;

constexpr double kSamePlace = 1e-6;  // lengths in a URDF that differ by less are considered equal [m]

void requireLength(double value, const char* what) {
  if (!(value >= 1e-6 && value <= 10))
    throw Error(std::string("has a collision shape whose ") + what +
                " is not between 1e-6 m and 10 m; write it in metres");
}

ToolShape makeSphere(const urdf::Sphere& sphere) {
  requireLength(sphere.radius, "radius");
  ToolShape result;
  result.shape = ShapePointer(new btSphereShape(static_cast<btScalar>(sphere.radius)));
  result.margin = sphere.radius;
  return result;
}

ToolShape makeBox(const urdf::Box& box) {
  for (const double side : {box.dim.x, box.dim.y, box.dim.z}) requireLength(side, "side");
  const btVector3 half(static_cast<btScalar>(box.dim.x / 2), static_cast<btScalar>(box.dim.y / 2),
                       static_cast<btScalar>(box.dim.z / 2));
  auto* shape = new btBoxShape(half);
  ToolShape result;
  result.shape = ShapePointer(shape);
  shape->setMargin(0);  // Bullet's default of 40 mm is larger than the whole tool
  return result;
}

ToolShape makeCylinder(const urdf::Cylinder& cylinder) {
  requireLength(cylinder.radius, "radius");
  requireLength(cylinder.length, "length");
  const btScalar radius = static_cast<btScalar>(cylinder.radius);
  auto* shape = new btCylinderShapeZ(btVector3(radius, radius, static_cast<btScalar>(cylinder.length / 2)));
  ToolShape result;
  result.shape = ShapePointer(shape);
  shape->setMargin(0);
  return result;
}

ToolShape makeCapsule(const urdf::Cylinder& cylinder) {
  requireLength(cylinder.radius, "radius");
  requireLength(cylinder.length, "length");
  ToolShape result;
  result.shape =
      ShapePointer(new btCapsuleShapeZ(static_cast<btScalar>(cylinder.radius), static_cast<btScalar>(cylinder.length)));
  result.margin = cylinder.radius;
  return result;
}

const urdf::Cylinder* asCylinder(const urdf::Collision& collision) {
  return dynamic_cast<const urdf::Cylinder*>(collision.geometry.get());
}

// the unused sphere of this radius at this point, or -1
int findSphere(const std::vector<urdf::CollisionSharedPtr>& all, const std::vector<bool>& used, double radius,
               const Eigen::Vector3d& centre) {
  for (std::size_t i = 0; i < all.size(); ++i) {
    const auto* sphere = dynamic_cast<const urdf::Sphere*>(all[i]->geometry.get());
    if (sphere == nullptr || used[i] || std::abs(sphere->radius - radius) > kSamePlace) continue;
    if ((toIsometry(all[i]->origin).translation() - centre).norm() < kSamePlace) return static_cast<int>(i);
  }
  return -1;
}

// removes the two end spheres of a cylinder if both exist
bool takeEnds(const urdf::Collision& collision, const std::vector<urdf::CollisionSharedPtr>& all,
              std::vector<bool>& used) {
  const urdf::Cylinder& cylinder = *asCylinder(collision);
  const Eigen::Isometry3d origin = toIsometry(collision.origin);
  const Eigen::Vector3d end(0, 0, cylinder.length / 2);
  const int upper = findSphere(all, used, cylinder.radius, origin * end);
  const int lower = findSphere(all, used, cylinder.radius, origin * -end);
  if (upper < 0 || lower < 0 || upper == lower) return false;
  used[upper] = used[lower] = true;
  return true;
}

ToolShape makeShape(const urdf::Geometry* geometry) {
  if (const auto* sphere = dynamic_cast<const urdf::Sphere*>(geometry)) return makeSphere(*sphere);
  if (const auto* box = dynamic_cast<const urdf::Box*>(geometry)) return makeBox(*box);
  if (const auto* cylinder = dynamic_cast<const urdf::Cylinder*>(geometry)) return makeCylinder(*cylinder);
  throw Error("has a mesh as collision shape; replace it by boxes, cylinders and spheres");
}

}  // namespace

Eigen::Isometry3d toIsometry(const urdf::Pose& pose) {
  double x = 0, y = 0, z = 0, w = 1;
  pose.rotation.getQuaternion(x, y, z, w);
  // urdfdom computed it with the C library, whose last bits vary from one machine to another
  for (double* part : {&x, &y, &z, &w}) *part = std::round(*part * 0x1p40) * 0x1p-40;
  Eigen::Isometry3d result = Eigen::Isometry3d::Identity();
  result.linear() = Eigen::Quaterniond(w, x, y, z).normalized().toRotationMatrix();
  result.translation() = Eigen::Vector3d(pose.position.x, pose.position.y, pose.position.z);
  return result;
}

std::optional<LinkMesh> makeMesh(const urdf::Link& link) {
  if (!link.visual) return std::nullopt;
  const auto* mesh = dynamic_cast<const urdf::Mesh*>(link.visual->geometry.get());
  if (mesh == nullptr) return std::nullopt;
  return LinkMesh{-1, toIsometry(link.visual->origin), {mesh->scale.x, mesh->scale.y, mesh->scale.z}, mesh->filename};
}

std::vector<ToolShape> makeShapes(const urdf::Link& link) {
  const auto& all = link.collision_array;
  std::vector<bool> used(all.size(), false);
  std::vector<ToolShape> shapes;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (asCylinder(*all[i]) == nullptr || !takeEnds(*all[i], all, used)) continue;
    used[i] = true;
    shapes.push_back(makeCapsule(*asCylinder(*all[i])));
    shapes.back().origin = toIsometry(all[i]->origin);
  }
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (used[i]) continue;
    shapes.push_back(makeShape(all[i]->geometry.get()));
    shapes.back().origin = toIsometry(all[i]->origin);
  }
  return shapes;
}

}  // namespace vibe
