#include <rviz/properties/bool_property.h>
#include <rviz/properties/color_property.h>
#include <rviz/properties/enum_property.h>
#include <rviz/properties/float_property.h>
#include <rviz/properties/vector_property.h>
#include <vibe_msgs/SutureArray.h>
#include <memory>
#include <optional>
#include <pluginlib/class_list_macros.hpp>

#include "displays/wall_listener.hpp"
#include "overlay/legend.hpp"
#include "vibe_graphics/geometry/blood_shapes.hpp"
#include "vibe_graphics/geometry/suture_drawing.hpp"
#include "vibe_graphics/geometry/suture_shapes.hpp"
#include "vibe_graphics/graphics/suture_visual.hpp"
#include "vibe_graphics/messages/suture_messages.hpp"
#include "vibe_rviz_plugins/display_base/message_display.hpp"
#include "vibe_rviz_plugins/display_base/topic_display.hpp"

namespace vibe::rviz_plugins {
namespace {

graphics::PackedColour packedOf(const QColor& colour) {
  return graphics::packed(colour.redF(), colour.greenF(), colour.blueF());
}

Ogre::Vector3 ogreOf(const Eigen::Vector3d& v) {
  return {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z())};
}

/// The shape of blood depends on the time of the message only if it pulses.
bool pulses(const graphics::SutureDrawing& scene) {
  for (const graphics::Wound& wound : scene.wounds)
    if (wound.brisk && wound.rate > 0) return true;
  return false;
}

Eigen::Isometry3d eigenOf(const FramePose& pose) {
  const Ogre::Quaternion& turn = pose.orientation;
  const Eigen::Translation3d place(pose.position.x, pose.position.y, pose.position.z);
  return place * Eigen::Quaterniond(turn.w, turn.x, turn.y, turn.z).normalized();
}

std::string contentOf(const graphics::SutureDrawing& scene) {
  std::size_t bites = 0;
  for (const graphics::SutureSet& set : scene.sets) bites += set.bites.size();
  return std::to_string(scene.sets.size()) + " sutures, " + std::to_string(bites) + " bites, " +
         std::to_string(scene.wounds.size()) + " bleedings.";
}

}  // namespace

/// Threads with bites, tension, T-tags, cinches, the recognised technique, and bleeding, from vibe_msgs/SutureArray.
class SutureDisplay : public MessageDisplay<vibe_msgs::SutureArray> {
  Q_OBJECT
 public:
  SutureDisplay() : MessageDisplay("sutures") {
    addThreadProperties();
    addPartProperties();
    addBleedingProperties();
  }

  ~SutureDisplay() override = default;

 protected:
  void onInitialize() override {
    MessageDisplay::onInitialize();
    changeStyle();
  }

  void onEnable() override {
    MessageDisplay::onEnable();
    changeLegend();
  }

  void onDisable() override {
    MessageDisplay::onDisable();
    changeLegend();
  }

 private Q_SLOTS:
  void changeStyle() {
    style_.colouring = static_cast<graphics::ThreadColour>(colour_property_->getOptionInt());
    style_.tension_map = graphics::ColourMap(map_property_->getStdString(), 0, max_property_->getFloat());
    style_.slack_colour = packedOf(slack_property_->getColor());
    style_.one_colour = packedOf(one_property_->getColor());
    style_.thread_diameter = diameter_property_->getFloat();
    style_.emphasis = emphasis_property_->getFloat();
    style_.bites = bites_property_->getBool();
    style_.ends = ends_property_->getBool();
    style_.corners = corners_property_->getBool();
    style_.links = links_property_->getBool();
    const Ogre::Vector3 down = down_property_->getVector();
    const Eigen::Vector3d direction(down.x, down.y, down.z);
    if (direction.norm() > 1e-6) blood_style_.down = direction.normalized();
    blood_style_.emphasis = style_.emphasis;
    for (rviz::Property* property :
         {static_cast<rviz::Property*>(map_property_), static_cast<rviz::Property*>(max_property_),
          static_cast<rviz::Property*>(slack_property_)})
      property->setHidden(style_.colouring != graphics::ThreadColour::Tension);
    one_property_->setHidden(style_.colouring != graphics::ThreadColour::One);
    threads_changed_ = blood_changed_ = true;
    changeLegend();
  }

  void changeLegend() {
    const bool wanted = visual_ && isEnabled() && legend_property_->getBool() && showsTension() && !scene_.sets.empty();
    legend_property_->setHidden(!showsTension());
    if (!wanted) {
      if (legend_) legend_->hide();
      return;
    }
    if (!legend_) legend_ = std::make_unique<Legend>(Legend::Place::BottomRight);
    legend_->show(drawnLegend("Thread tension [N]", style_.tension_map));
  }

 private:
  void addThreadProperties() {
    colour_property_ = new rviz::EnumProperty("Thread colour", "Tension",
                                              "Colour of the threads: their tension, one for all, or one per suture.",
                                              this, SLOT(changeStyle()));
    colour_property_->addOption("Tension", static_cast<int>(graphics::ThreadColour::Tension));
    colour_property_->addOption("One colour", static_cast<int>(graphics::ThreadColour::One));
    colour_property_->addOption("One per suture", static_cast<int>(graphics::ThreadColour::PerSuture));
    map_property_ = new rviz::EnumProperty("Colour map", "viridis",
                                           "Colours from no tension (dark) to the maximum tension (light).",
                                           colour_property_, SLOT(changeStyle()), this);
    for (const std::string& name : graphics::colourMapNames()) map_property_->addOptionStd(name);
    max_property_ = new rviz::FloatProperty("Maximum tension", 4,
                                            "Tension in newtons at the upper end of the colour map; a cinch pulls up "
                                            "to 3 N, a full-thickness bite tears out at about 8 N.",
                                            colour_property_, SLOT(changeStyle()), this);
    max_property_->setMin(0.01F);
    legend_property_ = new rviz::BoolProperty(
        "Legend", true, "Shows the colour scale in the lower right corner of the views, once there is a thread.",
        colour_property_, SLOT(changeLegend()), this);
    slack_property_ = new rviz::ColorProperty("Slack", QColor(237, 242, 255),
                                              "Colour of thread without tension, which alternates with a darker one.",
                                              colour_property_, SLOT(changeStyle()), this);
    one_property_ = new rviz::ColorProperty("Colour", QColor(31, 77, 217),
                                            "Colour of all threads; surgical polypropylene is dyed blue.",
                                            colour_property_, SLOT(changeStyle()), this);
    diameter_property_ = new rviz::FloatProperty("Thread diameter", 0.00032F,
                                                 "Diameter of the thread in metres; the default is that of size 2-0.",
                                                 this, SLOT(changeStyle()));
    diameter_property_->setMin(1e-5F);
    diameter_property_->setMax(0.01F);
    emphasis_property_ =
        new rviz::FloatProperty("Emphasis", 1,
                                "Factor by which threads are drawn thicker than they are; symbols grow with its "
                                "square root. With 3, threads are visible with the whole organ in view.",
                                this, SLOT(changeStyle()));
    emphasis_property_->setMin(0.1F);
    emphasis_property_->setMax(20);
  }

  void addPartProperties() {
    bites_property_ = new rviz::BoolProperty(
        "Bites", true, "Draws a green ring at every full-thickness bite and an orange ball at every partial one.", this,
        SLOT(changeStyle()));
    ends_property_ = new rviz::BoolProperty("T-tags and cinches", true,
                                            "Draws the T-tag at the end of the thread and the cinch at its start.",
                                            this, SLOT(changeStyle()));
    label_property_ = new rviz::BoolProperty("Technique", true,
                                             "Labels each set with its number and the recognised technique and its "
                                             "margin (0 to 1), or with its number of bites.",
                                             this, SLOT(changeStyle()));
    label_height_property_ = new rviz::FloatProperty("Height", 0.006F, "Height of the letters [m].", label_property_,
                                                     SLOT(changeStyle()), this);
    label_height_property_->setMin(1e-4F);
    corners_property_ = new rviz::BoolProperty("Transition points", true,
                                               "Draws a magenta ring around the bites at the corners of a U or Z.",
                                               this, SLOT(changeStyle()));
    links_property_ = new rviz::BoolProperty("Index groups", false,
                                             "Draws a dashed band between the bites that a technique brings together: "
                                             "the legs of a U, the diagonals of a Z, "
                                             "otherwise each bite and the next.",
                                             this, SLOT(changeStyle()));
  }

  void addBleedingProperties() {
    bleeding_property_ =
        new rviz::BoolProperty("Bleeding", true,
                               "Draws bleeding: a film and a rivulet that runs down the wall into a pool, a "
                               "pulsing jet if it is brisk, brown when it has stopped. Blood follows "
                               "the wall when tissue/topology and tissue/particles are there; otherwise "
                               "it lies on a plane.",
                               this, SLOT(changeStyle()));
    down_property_ = new rviz::VectorProperty("Down", Ogre::Vector3(-1, 0, 0),
                                              "Direction of gravity in the frame of the message; the default is for a "
                                              "patient in supine position.",
                                              bleeding_property_, SLOT(changeStyle()), this);
  }

  void makeVisual() override { visual_ = std::make_unique<graphics::SutureVisual>(*scene_node_); }

  void clear() override {
    scene_ = {};
    wall_.listen(update_nh_, false);
    blood_.setMesh(nullptr), blood_.setWounds({}, blood_style_);
    visual_->clear();
    changeLegend();
    threads_changed_ = blood_changed_ = false;
  }

  /// Compares the message with the one before, so that only what has changed is drawn again.
  MessageReport read(const vibe_msgs::SutureArray& message) override {
    graphics::SutureDrawing scene;
    const std::string wrong = graphics::readSutures(message, scene);
    if (!wrong.empty()) return {wrong, false};
    const bool threads_same = shown() != nullptr && shown()->sutures == message.sutures;
    const bool blood_same = threads_same && shown()->bleedings == message.bleedings && !pulses(scene);
    threads_changed_ |= !threads_same;
    blood_changed_ |= !blood_same;
    blood_style_.time = message.header.stamp.toSec();
    const bool first = scene_.sets.empty() != scene.sets.empty();
    scene_ = std::move(scene);
    if (first) changeLegend();
    return {contentOf(scene_)};
  }

  bool draw() override {
    const bool threads = threads_changed_;
    if (threads) drawThreads();
    threads_changed_ = false;
    const bool blood = drawBlood();
    return threads || blood;
  }

  void drawThreads() {
    shape_.clear();
    graphics::appendSutures(scene_, style_, shape_);
    visual_->showSolids(shape_);
    shape_.clear();
    graphics::appendLinks(scene_, style_, shape_);
    visual_->showSigns(shape_);
    drawLabels();
  }

  void drawLabels() {
    const double height = label_height_property_->getFloat();
    std::vector<graphics::SutureLabel> labels;
    for (std::size_t k = 0; k < scene_.sets.size() && label_property_->getBool(); ++k)
      if (!scene_.sets[k].bites.empty())
        labels.push_back(
            {graphics::labelOf(scene_.sets[k], k), ogreOf(graphics::labelPlace(scene_.sets[k], 2 * height))});
    visual_->showLabels(labels, height);
  }

  /// Called for every picture, because the wall moves by itself. @return whether the blood has changed
  bool drawBlood() {
    const bool wanted = bleeding_property_->getBool();
    wall_.listen(update_nh_, wanted && !scene_.wounds.empty());
    if (wall_.update()) blood_.setMesh(wall_.mesh());
    if (blood_changed_) blood_.setWounds(wanted ? scene_ : graphics::SutureDrawing{}, blood_style_);
    blood_changed_ = false;
    const std::optional<Eigen::Isometry3d> pose = wall_.vertices() != nullptr ? poseOfWall() : std::nullopt;
    const bool changed = blood_.update(pose ? wall_.vertices() : nullptr, pose.value_or(Eigen::Isometry3d::Identity()));
    if (changed) visual_->showBlood(blood_.shape());
    return changed;
  }

  /// Of the frame of the wall in that of the message; none: one of them is not known.
  std::optional<Eigen::Isometry3d> poseOfWall() {
    FramePose of_wall, of_message;
    if (!lookUpFrame(*context_, wall_.frame(), ros::Time(), of_wall).empty() ||
        !lookUpFrame(*context_, shown()->header.frame_id, ros::Time(), of_message).empty())
      return std::nullopt;
    return eigenOf(of_message).inverse() * eigenOf(of_wall);
  }

  bool showsTension() const { return style_.colouring == graphics::ThreadColour::Tension; }

  std::unique_ptr<graphics::SutureVisual> visual_;
  std::unique_ptr<Legend> legend_;
  graphics::SutureDrawing scene_;
  graphics::SutureStyle style_;
  graphics::BloodStyle blood_style_;
  WallListener wall_;
  graphics::BleedingShape blood_;
  graphics::ColouredShape shape_;  // a member to reuse its memory
  bool threads_changed_ = false, blood_changed_ = false;

  rviz::EnumProperty *colour_property_, *map_property_;
  rviz::FloatProperty *max_property_, *diameter_property_, *emphasis_property_, *label_height_property_;
  rviz::ColorProperty *slack_property_, *one_property_;
  rviz::BoolProperty *legend_property_, *bites_property_, *ends_property_, *label_property_, *corners_property_,
      *links_property_, *bleeding_property_;
  rviz::VectorProperty* down_property_;
};

}  // namespace vibe::rviz_plugins

PLUGINLIB_EXPORT_CLASS(vibe::rviz_plugins::SutureDisplay, rviz::Display)

#include "suture_display.moc"
