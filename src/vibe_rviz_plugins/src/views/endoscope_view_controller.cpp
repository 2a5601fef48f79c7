#include "views/endoscope_view_controller.hpp"

#include <OgreCamera.h>
#include <OgreException.h>
#include <OgreSceneNode.h>
#include <rviz/display_context.h>
#include <rviz/frame_manager.h>
#include <rviz/properties/bool_property.h>
#include <rviz/properties/enum_property.h>
#include <rviz/properties/float_property.h>
#include <rviz/properties/string_property.h>
#include <rviz/properties/tf_frame_property.h>
#include <rviz/render_panel.h>
#include <rviz/view_manager.h>
#include <rviz/viewport_mouse_event.h>

#include <QCursor>
#include <cmath>

#include "vibe_graphics/graphics/offscreen_camera.hpp"
#include "vibe_rviz_plugins/display_base/topic_display.hpp"

namespace vibe::rviz_plugins {
namespace {

const char* const kFrame = "scope_camera_optical";
constexpr float kFieldOfView = 140;  // of gastroscopes [degrees]

}  // namespace

EndoscopeViewController::EndoscopeViewController() {
  // The property has no effect here, and rviz hides it with a delayed signal that crashes if the view has been
  // replaced by then, which happens on a busy machine.
  stereo_.reset(takeChild(stereo_enable_));
  frame_ = new rviz::TfFrameProperty("Camera Frame", kFrame,
                                     "Frame of the endoscope's camera: z forward, x right, y down.", this);
  field_of_view_ = new rviz::FloatProperty(
      "Field of view", kFieldOfView, "Angle across the circular image in degrees; most gastroscopes have 140.", this);
  field_of_view_->setMin(static_cast<float>(graphics::kMinFieldOfView / graphics::kDegree));
  field_of_view_->setMax(static_cast<float>(graphics::kMaxFieldOfView / graphics::kDegree));
  lens_ = new rviz::EnumProperty(
      "Lens", "Equidistant",
      "Equidistant: the radius is proportional to the angle, as in real endoscopes. Rectilinear: "
      "straight lines stay straight, and the centre is small.",
      this);
  lens_->addOption("Equidistant", static_cast<int>(graphics::LensKind::Equidistant));
  lens_->addOption("Rectilinear", static_cast<int>(graphics::LensKind::Rectilinear));
  sharpness_ =
      new rviz::FloatProperty("Sharpness", 1,
                              "Resolution relative to the centre of the image. 1 draws every detail; less is faster, "
                              "which helps without a graphics card.",
                              this);
  sharpness_->setMin(0.2f);
  sharpness_->setMax(2);
  auto_exposure_ = new rviz::BoolProperty(
      "Automatic exposure", true, "Whether the brightness follows the picture, as that of a video processor.", this);
  status_ = new rviz::StringProperty("Status", "", "Whether the view can follow the endoscope.", this);
  status_->setReadOnly(true);
  status_->setShouldBeSaved(false);
}

EndoscopeViewController::~EndoscopeViewController() = default;

void EndoscopeViewController::onInitialize() {
  frame_->setFrameManager(context_->getFrameManager());
  near_clip_property_->setMin(graphics::kScopeNearClip);
  near_clip_property_->setFloat(graphics::kScopeNearClip);
  camera_->setFarClipDistance(graphics::kScopeFarClip);
  camera_->setProjectionType(Ogre::PT_PERSPECTIVE);
}

void EndoscopeViewController::onActivate() {
  picture_ = std::make_unique<graphics::EndoscopeLens>(*context_->getViewManager()->getRenderPanel()->getViewport());
  broken_ = false;
  updateScope();
  bendPicture();
}

void EndoscopeViewController::update(float dt, float /*ros_dt*/) {
  expose(dt);
  updateScope();
  bendPicture();
}

void EndoscopeViewController::updateScope() {
  FramePose pose;
  const std::string wrong = lookUpFrame(*context_, frame_->getFrameStd(), ros::Time(), pose);
  if (!wrong.empty()) {
    showStatus(QString::fromStdString(wrong));
    return;
  }
  camera_->setPosition(pose.position);
  camera_->setOrientation(pose.orientation * graphics::opticalToOgre());
  if (!broken_) showStatus("");
}

void EndoscopeViewController::bendPicture() {
  if (!picture_ || broken_) return;
  try {
    picture_->set(static_cast<graphics::LensKind>(lens_->getOptionInt()),
                  field_of_view_->getFloat() * graphics::kDegree, sharpness_->getFloat());
    context_->queueRender();
  } catch (const std::exception& error) {  // std::runtime_error and Ogre::Exception
    broken_ = true;
    showStatus(error.what());
  }
}

void EndoscopeViewController::expose(float passed) {
  if (!picture_ || broken_) return;
  time_ += static_cast<double>(passed);
  const std::optional<double> level = auto_exposure_->getBool() ? picture_->level() : std::nullopt;
  if (level) exposure_.see(*level, time_);
  picture_->setGain(level ? exposure_.gain() : graphics::AutoExposure::kFixedGain);
}

void EndoscopeViewController::showStatus(const QString& text) {
  const bool changed = status_->getString() != text;
  if (changed) status_->setString(text);
  // other messages replace the status line of rviz, so a fault is repeated
  if (changed || !text.isEmpty()) setStatus(text);
}

void EndoscopeViewController::handleMouseEvent(rviz::ViewportMouseEvent& /*event*/) {
  if (status_->getString().isEmpty())
    setStatus("The view follows the endoscope; choose another type of view to move freely.");
}

void EndoscopeViewController::reset() {
  frame_->setValue(kFrame);
  field_of_view_->setFloat(kFieldOfView);
  lens_->setString("Equidistant");
  sharpness_->setFloat(1);
  auto_exposure_->setBool(true);
}

rviz::Property* EndoscopeViewController::subProp(const QString& name) {
  return name == "Target Frame" ? &no_target_ : rviz::ViewController::subProp(name);
}

}  // namespace vibe::rviz_plugins

#include <pluginlib/class_list_macros.hpp>
PLUGINLIB_EXPORT_CLASS(vibe::rviz_plugins::EndoscopeViewController, rviz::ViewController)
