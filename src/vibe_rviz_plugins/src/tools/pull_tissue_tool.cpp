#include <OgreCamera.h>
#include <OgreRay.h>
#include <OgreViewport.h>
#include <ros/ros.h>
#include <rviz/display_context.h>
#include <rviz/properties/float_property.h>
#include <rviz/properties/string_property.h>
#include <rviz/render_panel.h>
#include <rviz/tool.h>
#include <rviz/view_controller.h>
#include <rviz/viewport_mouse_event.h>
#include <sensor_msgs/PointCloud2.h>
#include <vibe_msgs/TissuePull.h>
#include <vibe_msgs/TissuePullState.h>
#include <vibe_msgs/TissueTopology.h>
#include <Eigen/Geometry>
#include <cstdio>
#include <memory>
#include <optional>
#include <pluginlib/class_list_macros.hpp>
#include <string>

#include "tools/pull_visual.hpp"
#include "vibe_graphics/geometry/tissue_mesh.hpp"
#include "vibe_graphics/messages/tissue_messages.hpp"
#include "vibe_operator/drive/mouse_ray.hpp"
#include "vibe_operator/messages/command_messages.hpp"
#include "vibe_rviz_plugins/display_base/topic_display.hpp"
#include "views/endoscope_view_controller.hpp"

namespace vibe::rviz_plugins {
namespace {

constexpr double kWheelStep = 2e-3 / 120;  // motion in depth [m per eighth of a degree of the wheel]
constexpr double kAnswerTimeout = 3;       // without an answer before a status says so [s]

Eigen::Vector3d toEigen(const Ogre::Vector3& v) {
  return {v.x, v.y, v.z};
}

// Works in the views of rviz and in the endoscope view, whose lens distorts the picture.
Ogre::Ray viewRay(const rviz::ViewportMouseEvent& event, int x, int y) {
  const Ogre::Camera& camera = *event.viewport->getCamera();
  const auto* scope = dynamic_cast<const EndoscopeViewController*>(event.panel->getViewController());
  if (scope != nullptr && scope->roundCamera() != nullptr) {
    const Eigen::Vector3f ray = graphics::rayOf(*scope->roundCamera(), Eigen::Vector2d(x, y)).cast<float>();
    return {camera.getDerivedPosition(), camera.getDerivedOrientation() * Ogre::Vector3(ray.x(), -ray.y(), -ray.z())};
  }
  return camera.getCameraToViewportRay(static_cast<float>(x) / static_cast<float>(event.viewport->getActualWidth()),
                                       static_cast<float>(y) / static_cast<float>(event.viewport->getActualHeight()));
}

}  // namespace

/// Pulls the tissue under the mouse with commands on tissue/pull. Subscribes to the tissue only while it is the active
/// tool.
class PullTissueTool : public rviz::Tool {
  Q_OBJECT

 public:
  PullTissueTool() {
    shortcut_key_ = 'p';
    namespace_ =
        new rviz::StringProperty("Namespace", "", "Namespace of the topics of the simulator; empty: that of rviz.",
                                 getPropertyContainer(), SLOT(connectAgain()), this);
    scale_ = new rviz::FloatProperty("Arrow per newton", 20, "Length of the arrow for a force of 1 N [mm].",
                                     getPropertyContainer());
    scale_->setMin(0.1F);
    scale_->setMax(1000);
  }

  ~PullTissueTool() override { letGo(); }

  void onInitialize() override {
    handle_.setCallbackQueue(context_->getUpdateQueue());
    visual_ = std::make_unique<PullVisual>(*scene_manager_);
  }

  void activate() override {
    active_ = true;
    connect();
    showHowTo();
  }

  void deactivate() override {
    letGo();
    active_ = false;
    disconnect();
  }

  void update(float, float) override {
    if (!hold_) return;
    send(hold_->particle, hold_->target());
    if ((ros::WallTime::now() - hold_->since).toSec() < kAnswerTimeout) return;
    showStatus("The simulator does not answer on " + state_subscriber_.getTopic() +
               "; is it paused, or is the tissue fixed there?");
  }

  int processMouseEvent(rviz::ViewportMouseEvent& event) override {
    if (event.leftDown()) {
      take(event);
      return Render;
    }
    if (event.leftUp()) {
      letGo();
      return Render;
    }
    if (hold_ && event.type == QEvent::MouseMove && !event.left()) letGo();  // released outside of rviz
    if (hold_ && (event.left() || event.wheel_delta != 0)) {
      drag(event);
      return Render;
    }
    const bool of_view =
        event.middle() || event.right() || event.acting_button != Qt::NoButton || event.wheel_delta != 0;
    if (!of_view || event.left() || event.panel->getViewController() == nullptr) return 0;
    event.panel->getViewController()->handleMouseEvent(event);
    showHowTo();  // replaces the status text that the view has just set
    return Render;
  }

 private Q_SLOTS:
  void connectAgain() {
    if (!active_) return;
    letGo();
    disconnect();
    connect();
  }

 private:
  /// What the mouse holds. Positions are in the frame of the topology.
  struct Hold {
    int particle = -1;
    Eigen::Vector3d place = Eigen::Vector3d::Zero();   ///< of the tissue when it was grabbed [m]
    Eigen::Vector3d drag = Eigen::Vector3d::Zero();    ///< motion of the mouse since then [m]
    Eigen::Vector3d cursor = Eigen::Vector3d::Zero();  ///< point under the mouse at the depth of the target [m]
    bool answered = false;                             ///< the simulator has answered
    ros::WallTime since;                               ///< time of the last answer, or of the start
    Eigen::Vector3d target() const { return place + drag; }
  };

  void connect() {
    const std::string name = namespace_->getStdString();
    const std::string prefix = name.empty() || name.back() == '/' ? name : name + "/";
    topology_trouble_ =
        "No message on " + handle_.resolveName(prefix + "tissue/topology") + " yet; start a simulator first.";
    try {
      publisher_ = handle_.advertise<vibe_msgs::TissuePull>(prefix + "tissue/pull", 10);
      topology_subscriber_ = handle_.subscribe(prefix + "tissue/topology", 2, &PullTissueTool::takeTopology, this);
      particles_subscriber_ = handle_.subscribe(prefix + "tissue/particles", 1, &PullTissueTool::takeParticles, this);
      state_subscriber_ = handle_.subscribe(prefix + "tissue/pull_state", 10, &PullTissueTool::takeState, this);
    } catch (const ros::Exception& error) {
      topology_trouble_ = "The namespace '" + name + "' of the tool is invalid; change it in Tool Properties.";
      showStatus(topology_trouble_);
    }
  }

  void disconnect() {
    topology_subscriber_.shutdown();
    particles_subscriber_.shutdown();
    state_subscriber_.shutdown();
    publisher_.shutdown();
    latest_.reset();
    mesh_ = graphics::TissueMesh();
  }

  void takeTopology(const vibe_msgs::TissueTopology::ConstPtr& message) {
    letGo();  // the particle numbers have changed
    topology_trouble_ = graphics::readTopology(*message, mesh_);
    if (!topology_trouble_.empty()) showStatus(topology_trouble_);
  }

  void takeParticles(const sensor_msgs::PointCloud2::ConstPtr& message) { latest_ = message; }

  void takeState(const vibe_msgs::TissuePullState::ConstPtr& message) {
    if (!hold_) return;
    operating::PullState state;
    const std::string wrong = operating::readPullState(*message, state);
    if (!wrong.empty()) return showStatus(wrong);
    if (state.particle != hold_->particle) return;
    if (!hold_->answered)
      hold_->place = state.position;  // the centre of the patch, so that a click alone does not pull
    hold_->answered = true;
    hold_->since = ros::WallTime::now();
    draw(state.position, state.force);
  }

  // Empty if there is tissue to hold, otherwise the reason why not.
  std::string findTissue() {
    if (!topology_trouble_.empty()) return topology_trouble_;
    if (!latest_) return "No message on " + particles_subscriber_.getTopic() + " yet; is the simulator running?";
    if (publisher_.getNumSubscribers() == 0)
      return "Nobody subscribes to " + publisher_.getTopic() + "; is the simulator still running?";
    return graphics::readParticles(*latest_, mesh_, tissue_);
  }

  bool framePose(Eigen::Isometry3d& pose) {
    FramePose found;
    const std::string wrong = lookUpFrame(*context_, mesh_.frame_id, ros::Time(), found);
    if (!wrong.empty()) {
      showStatus(wrong);
      return false;
    }
    visual_->setPose(found.position, found.orientation);
    const Ogre::Quaternion& q = found.orientation;
    pose = Eigen::Translation3d(toEigen(found.position)) * Eigen::Quaterniond(q.w, q.x, q.y, q.z);
    return true;
  }

  /// Ray through the mouse, or this number of pixels below it.
  operating::MouseRay rayOf(const rviz::ViewportMouseEvent& event, const Eigen::Isometry3d& frame,
                            int below = 0) const {
    const Ogre::Ray ray = viewRay(event, event.x, event.y + below);
    const Eigen::Isometry3d inverse = frame.inverse();
    return {inverse * toEigen(ray.getOrigin()), (inverse.linear() * toEigen(ray.getDirection())).normalized()};
  }

  Eigen::Vector3d viewDirection(const rviz::ViewportMouseEvent& event, const Eigen::Isometry3d& frame) const {
    return frame.linear().transpose() * toEigen(event.viewport->getCamera()->getDerivedDirection());
  }

  void take(const rviz::ViewportMouseEvent& event) {
    letGo();
    Eigen::Isometry3d frame;
    const std::string trouble = findTissue();
    if (!trouble.empty()) return showStatus(trouble);
    if (!framePose(frame)) return;
    const auto hit = operating::firstHit(rayOf(event, frame), tissue_.positions, mesh_.particle_triangles);
    if (!hit) return showStatus("There is no tissue under the mouse; press the left button on the tissue.");
    Hold hold;
    hold.particle = static_cast<int>(hit->particle);
    const float* place = &tissue_.positions[3 * static_cast<std::size_t>(hit->particle)];
    hold.place = Eigen::Vector3d(place[0], place[1], place[2]);
    hold.cursor = hit->place;
    hold.since = ros::WallTime::now();
    hold_ = hold;
    send(hold.particle, hold.target());
    visual_->showPull(hold.place, hold.target());
    showHowTo();
  }

  void drag(rviz::ViewportMouseEvent& event) {
    Eigen::Isometry3d frame;
    if (!framePose(frame)) return;
    const Eigen::Vector3d along = viewDirection(event, frame);
    const auto under = operating::meetPlane(rayOf(event, frame), hold_->cursor, along);
    if (!under) return;
    const bool deeper = event.wheel_delta != 0 || event.shift();
    if (!deeper) {
      hold_->drag += *under - hold_->cursor;
      hold_->cursor = *under;
      return;
    }
    const Eigen::Vector3d pixel =
        operating::meetPlane(rayOf(event, frame, 1), hold_->cursor, along).value_or(*under) - *under;
    const double way =
        event.wheel_delta != 0 ? kWheelStep * event.wheel_delta : pixel.norm() * (event.last_y - event.y);
    hold_->drag += way * along;
    hold_->cursor =
        operating::meetPlane(rayOf(event, frame), hold_->cursor + way * along, along).value_or(hold_->cursor);
  }

  void letGo() {
    if (!hold_) return;
    send(-1, Eigen::Vector3d::Zero());
    hold_.reset();
    if (visual_) visual_->hide();
    if (active_) showHowTo();
  }

  void send(int particle, const Eigen::Vector3d& target) {
    if (!publisher_ || !ros::ok()) return;
    vibe_msgs::TissuePull message;
    message.header.stamp = ros::Time::now();
    message.header.frame_id = mesh_.frame_id;
    message.particle = particle;
    message.target.x = target.x(), message.target.y = target.y(), message.target.z = target.z();
    publisher_.publish(message);
  }

  void showStatus(const std::string& text) { setStatus(QString::fromStdString(text)); }

  void showHowTo() {
    showStatus(
        "Left button: hold and pull the tissue. Wheel or Shift: towards you or away. Middle and right button: move the "
        "view.");
  }

  void draw(const Eigen::Vector3d& place, const Eigen::Vector3d& force) {
    Eigen::Isometry3d frame;
    if (!framePose(frame)) return;
    visual_->showPull(place, hold_->target());
    visual_->showForce(place, force, 1e-3 * static_cast<double>(scale_->getFloat()));
    char text[160];
    std::snprintf(text, sizeof text,
                  "%.2f N at particle %d. Wheel or Shift: towards you or away. Release the button to let go.",
                  force.norm(), hold_->particle);
    showStatus(text);
    context_->queueRender();
  }

  rviz::StringProperty* namespace_;
  rviz::FloatProperty* scale_;

  ros::NodeHandle handle_;
  ros::Publisher publisher_;
  ros::Subscriber topology_subscriber_, particles_subscriber_, state_subscriber_;
  sensor_msgs::PointCloud2::ConstPtr latest_;
  graphics::TissueMesh mesh_;
  graphics::TissueFrame tissue_;
  std::string topology_trouble_;  // why there is no mesh; empty if there is one
  std::optional<Hold> hold_;
  std::unique_ptr<PullVisual> visual_;
  bool active_ = false;
};

}  // namespace vibe::rviz_plugins

PLUGINLIB_EXPORT_CLASS(vibe::rviz_plugins::PullTissueTool, rviz::Tool)

#include "pull_tissue_tool.moc"
