#include <OgreRenderTargetListener.h>
#include <OgreRenderWindow.h>
#include <ros/publisher.h>
#include <rviz/display_context.h>
#include <rviz/properties/float_property.h>
#include <rviz/properties/string_property.h>
#include <rviz/render_panel.h>
#include <rviz/view_manager.h>
#include <sensor_msgs/JointState.h>
#include <vibe_msgs/DisplayTiming.h>
#include <QImage>
#include <algorithm>
#include <memory>
#include <pluginlib/class_list_macros.hpp>

#include "overlay/legend.hpp"
#include "vibe_rviz_plugins/display_base/message_display.hpp"

namespace vibe::rviz_plugins {
namespace {

constexpr int kSize = 64;  // of the lamp [pixels]
const QColor kLit(0, 255, 0), kDark(255, 0, 255);

QImage lampImage(bool lit) {
  QImage image(kSize, kSize, QImage::Format_ARGB32);
  image.fill(lit ? kLit : kDark);
  return image;
}

ros::Time wallTime() {
  const ros::WallTime now = ros::WallTime::now();
  return {now.sec, now.nsec};
}

}  // namespace

/// A lamp in the corner of the view that is green while a joint is above a threshold and magenta below, for measuring
/// how long a motion takes to become visible: by a program that reads its pixels, or by a camera in front of the
/// screen. Whenever it changes, the display publishes when it read the message and when it rendered the frame.
class LatencyLampDisplay : public MessageDisplay<sensor_msgs::JointState>, private Ogre::RenderTargetListener {
  Q_OBJECT
 public:
  LatencyLampDisplay() : MessageDisplay("scope/setpoint_js") {
    joint_property_ =
        new rviz::StringProperty("Joint", "tip_left_right", "The joint that switches the lamp.", this, SLOT(redraw()));
    threshold_property_ = new rviz::FloatProperty(
        "Threshold", 0, "The lamp is green while the position of the joint [m or rad] is above it.", this,
        SLOT(redraw()));
  }

  ~LatencyLampDisplay() override {
    if (window_ != nullptr) window_->removeListener(this);
  }

 protected:
  void onInitialize() override {
    MessageDisplay::onInitialize();
    publisher_ = update_nh_.advertise<vibe_msgs::DisplayTiming>("latency_lamp", 100);
    rviz::RenderPanel* panel = context_->getViewManager()->getRenderPanel();
    if (panel == nullptr) return;  // in a program without a window
    window_ = panel->getRenderWindow();
    window_->addListener(this);
  }

  void onEnable() override {
    MessageDisplay::onEnable();
    drawn_ = false;
  }

  void onDisable() override {
    MessageDisplay::onDisable();
    if (lamp_) lamp_->hide();
  }

 private:
  void makeVisual() override { lamp_ = std::make_unique<Legend>(Legend::Place::TopRight); }

  void clear() override {
    lamp_->hide();
    drawn_ = pending_ = false;
  }

  MessageReport read(const sensor_msgs::JointState& message) override {
    const std::string joint = joint_property_->getStdString();
    const auto found = std::find(message.name.begin(), message.name.end(), joint);
    const auto index = static_cast<std::size_t>(found - message.name.begin());
    if (index >= message.name.size() || index >= message.position.size())
      return {"The message has no position of a joint '" + joint + "'; set Joint to one that it has.", false};
    const bool lit = message.position[index] > static_cast<double>(threshold_property_->getFloat());
    if (drawn_ && lit == static_cast<bool>(timing_.lit)) return {lit ? "The lamp is green." : "The lamp is magenta."};
    timing_.header.stamp = message.header.stamp;
    timing_.lit = lit;
    timing_.received = wallTime();
    drawn_ = false;
    return {lit ? "The lamp is green." : "The lamp is magenta."};
  }

  bool draw() override {
    if (drawn_ || shown() == nullptr) return false;
    lamp_->show(lampImage(timing_.lit));
    drawn_ = pending_ = true;
    return true;
  }

  void postRenderTargetUpdate(const Ogre::RenderTargetEvent&) override {
    if (!pending_) return;
    pending_ = false;
    timing_.rendered = wallTime();
    publisher_.publish(timing_);
  }

  rviz::StringProperty* joint_property_;
  rviz::FloatProperty* threshold_property_;
  ros::Publisher publisher_;
  Ogre::RenderTarget* window_ = nullptr;
  std::unique_ptr<Legend> lamp_;
  vibe_msgs::DisplayTiming timing_;  // of the last change
  bool drawn_ = false;               // the lamp shows timing_.lit
  bool pending_ = false;             // the frame with it has not been rendered yet
};

}  // namespace vibe::rviz_plugins

PLUGINLIB_EXPORT_CLASS(vibe::rviz_plugins::LatencyLampDisplay, rviz::Display)

#include "latency_lamp_display.moc"
