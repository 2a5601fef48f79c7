#include "displays/suture_display.hpp"

#include <OgreSceneNode.h>
#include <ros/message_traits.h>
#include <rviz/display_context.h>
#include <rviz/frame_manager.h>
#include <rviz/properties/bool_property.h>
#include <rviz/properties/color_property.h>
#include <rviz/properties/enum_property.h>
#include <rviz/properties/float_property.h>
#include <rviz/properties/ros_topic_property.h>
#include <rviz/properties/vector_property.h>

#include <pluginlib/class_list_macros.hpp>

#include "messages/suture_messages.hpp"
#include "render/legend.hpp"

namespace vibe {
namespace {

using rviz::StatusProperty;

const char* const kStatusTopic = "Topic";
const char* const kStatusMessage = "Message";
const char* const kStatusTransform = "Transform";

QString messageType() {
  return QString::fromStdString(ros::message_traits::datatype<vibe_msgs::SutureArray>());
}

PackedColour packedOf(const QColor& colour) {
  return packed(colour.redF(), colour.greenF(), colour.blueF());
}

Ogre::Vector3 ogreOf(const Eigen::Vector3d& v) {
  return {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z())};
}

/// Blood moves with the time of the message only where it pulses.
bool pulses(const SutureScene& scene) {
  for (const Wound& wound : scene.wounds)
    if (wound.brisk && wound.rate > 0) return true;
  return false;
}

}  // namespace

SutureDisplay::SutureDisplay() {
  topic_property_ = new rviz::RosTopicProperty("Topic", "sutures", messageType(),
                                               "vibe_msgs/SutureArray topic with the threads of the session.", this,
                                               SLOT(changeTopic()));
  addThreadProperties();
  addPartProperties();
  addBleedingProperties();
}

SutureDisplay::~SutureDisplay() = default;

void SutureDisplay::addThreadProperties() {
  colour_property_ = new rviz::EnumProperty("Thread colour", "Tension",
                                            "Colour of the threads: their tension, one for all, or one per suture.",
                                            this, SLOT(changeStyle()));
  colour_property_->addOption("Tension", static_cast<int>(ThreadColour::Tension));
  colour_property_->addOption("One colour", static_cast<int>(ThreadColour::One));
  colour_property_->addOption("One per suture", static_cast<int>(ThreadColour::PerSuture));
  map_property_ = new rviz::EnumProperty("Colour map", "viridis", "From no tension (dark) to the greatest (light).",
                                         colour_property_, SLOT(changeStyle()), this);
  for (const std::string& name : colourMapNames()) map_property_->addOptionStd(name);
  max_property_ = new rviz::FloatProperty("Greatest tension", 4,
                                          "Tension in newtons at the upper end of the colour map; a cinch draws "
                                          "until 3 N, a full bite tears out at about 8 N.",
                                          colour_property_, SLOT(changeStyle()), this);
  max_property_->setMin(0.01F);
  legend_property_ = new rviz::BoolProperty(
      "Legend", true, "Shows what the colours mean in the lower right corner of the views, once there is a thread.",
      colour_property_, SLOT(changeLegend()), this);
  slack_property_ = new rviz::ColorProperty("Slack", QColor(237, 242, 255),
                                            "Colour of thread without tension, in bands with a darker one.",
                                            colour_property_, SLOT(changeStyle()), this);
  one_property_ = new rviz::ColorProperty("Colour", QColor(31, 77, 217),
                                          "Colour of all threads; polypropylene for surgery is dyed blue.",
                                          colour_property_, SLOT(changeStyle()), this);
  diameter_property_ = new rviz::FloatProperty("Thread diameter", 0.00032F,
                                               "Diameter of the thread in metres; the default is that of size 2-0.",
                                               this, SLOT(changeStyle()));
  diameter_property_->setMin(1e-5F);
  diameter_property_->setMax(0.01F);
  emphasis_property_ = new rviz::FloatProperty("Emphasis", 1,
                                               "Threads are drawn this many times as thick as they are, symbols grow "
                                               "with its square root; 3 can be read with the whole organ in view.",
                                               this, SLOT(changeStyle()));
  emphasis_property_->setMin(0.1F);
  emphasis_property_->setMax(20);
}

void SutureDisplay::addPartProperties() {
  bites_property_ = new rviz::BoolProperty(
      "Bites", true, "Draws a green ring at every bite through the whole wall and an orange ball at every partial one.",
      this, SLOT(changeStyle()));
  ends_property_ = new rviz::BoolProperty("T-tags and cinches", true,
                                          "Draws the bar at the thread's end and the bobbin that holds its beginning.",
                                          this, SLOT(changeStyle()));
  label_property_ = new rviz::BoolProperty(
      "Technique", true,
      "Writes at each set its number, the recognised technique and how sure it is (0 to 1), or how many bites it has.",
      this, SLOT(changeStyle()));
  label_height_property_ = new rviz::FloatProperty("Height", 0.006F, "Height of the letters in metres.",
                                                   label_property_, SLOT(changeStyle()), this);
  label_height_property_->setMin(1e-4F);
  corners_property_ = new rviz::BoolProperty("Transition points", true,
                                             "Draws a magenta ring around the bites at which a U or Z turns.", this,
                                             SLOT(changeStyle()));
  links_property_ = new rviz::BoolProperty(
      "Index groups", false,
      "Draws a broken band between the bites whose tissue a technique brings together: the legs of a U, the diagonals "
      "of a Z, of all others each bite and the next.",
      this, SLOT(changeStyle()));
}

void SutureDisplay::addBleedingProperties() {
  bleeding_property_ = new rviz::BoolProperty("Bleeding", true,
                                              "Draws mild bleeding as a dark film that grows, brisk bleeding as a "
                                              "bright jet that pulses, and what has stopped in brown.",
                                              this, SLOT(changeStyle()));
  down_property_ = new rviz::VectorProperty("Down", Ogre::Vector3(-1, 0, 0),
                                            "Direction of gravity in the frame of the message; the default is a "
                                            "patient on the back.",
                                            bleeding_property_, SLOT(changeStyle()), this);
}

void SutureDisplay::onInitialize() {
  try {
    visual_ = std::make_unique<SutureVisual>(*scene_node_);
  } catch (const std::exception& error) {
    setStatusStd(StatusProperty::Error, "Resources", error.what());
  }
  changeStyle();
}

void SutureDisplay::onEnable() {
  subscribe();
  changeLegend();
}

void SutureDisplay::onDisable() {
  subscriber_.shutdown();
  reset();
  changeLegend();
}

void SutureDisplay::setTopic(const QString& topic, const QString&) {
  topic_property_->setString(topic);
}

void SutureDisplay::changeTopic() {
  reset();
}

void SutureDisplay::subscribe() {
  subscriber_.shutdown();
  if (!visual_) return;
  const std::string topic = topic_property_->getTopicStd();
  if (topic.empty()) {
    setStatus(StatusProperty::Error, kStatusTopic, "No topic is set; choose one of type vibe_msgs/SutureArray.");
    return;
  }
  try {
    // only the newest counts: every message tells everything
    subscriber_ = update_nh_.subscribe(topic, 1, &SutureDisplay::receive, this);
    setStatusStd(StatusProperty::Warn, kStatusTopic, "No message on '" + topic + "' yet; is the simulator running?");
    waiting_ = true;
  } catch (const ros::Exception& error) {
    setStatusStd(StatusProperty::Error, kStatusTopic, std::string("Cannot listen: ") + error.what() + ".");
  }
}

void SutureDisplay::reset() {
  Display::reset();
  latest_.reset(), shown_.reset();
  scene_ = {};
  if (visual_) visual_->clear();
  changeLegend();
  threads_changed_ = blood_changed_ = false;
  placed_.reset();
  said_.clear();
  if (isEnabled()) subscribe();  // the topic is latched: it comes again
}

void SutureDisplay::receive(const vibe_msgs::SutureArray::ConstPtr& message) {
  if (waiting_) setStatus(StatusProperty::Ok, kStatusTopic, "Messages arrive.");
  waiting_ = false;
  latest_ = message;
}

void SutureDisplay::changeStyle() {
  style_.colouring = static_cast<ThreadColour>(colour_property_->getOptionInt());
  style_.tension_map = ColourMap(map_property_->getStdString(), 0, max_property_->getFloat());
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
    property->setHidden(style_.colouring != ThreadColour::Tension);
  one_property_->setHidden(style_.colouring != ThreadColour::One);
  threads_changed_ = blood_changed_ = true;
  changeLegend();
}

void SutureDisplay::changeLegend() {
  const bool wanted = visual_ && isEnabled() && legend_property_->getBool() && showsTension() && !scene_.sets.empty();
  legend_property_->setHidden(!showsTension());
  if (!wanted) {
    if (legend_) legend_->hide();
    return;
  }
  if (!legend_) legend_ = std::make_unique<Legend>(Legend::Corner::BottomRight);
  legend_->show(drawnLegend("Thread tension [N]", style_.tension_map));
}

void SutureDisplay::fixedFrameChanged() {
  placed_.reset();
}

void SutureDisplay::update(float, float) {
  if (!visual_) return;
  if (latest_) report();
  if (!shown_) return;
  place();
  if (!threads_changed_ && !blood_changed_) return;
  if (threads_changed_) draw();
  if (blood_changed_) drawBlood();
  threads_changed_ = blood_changed_ = false;
  context_->queueRender();
}

/// Reads the newest message and finds out what of it is new.
void SutureDisplay::report() {
  const vibe_msgs::SutureArray::ConstPtr message = latest_;
  latest_.reset();
  SutureScene scene;
  const std::string wrong = readSutures(*message, scene);
  if (!wrong.empty()) {
    if (wrong != said_) setStatusStd(StatusProperty::Error, kStatusMessage, wrong);
    said_ = wrong;
    return;
  }
  std::size_t bites = 0;
  for (const SutureSet& set : scene.sets) bites += set.bites.size();
  const std::string said = std::to_string(scene.sets.size()) + " sutures, " + std::to_string(bites) + " bites, " +
                           std::to_string(scene.wounds.size()) + " bleedings.";
  if (said != said_) setStatusStd(StatusProperty::Ok, kStatusMessage, said);  // a status costs more than drawing
  said_ = said;
  const bool threads_same = shown_ && shown_->sutures == message->sutures;
  const bool blood_same = threads_same && shown_->bleedings == message->bleedings && !pulses(scene);
  threads_changed_ |= !threads_same;
  blood_changed_ |= !blood_same;
  blood_style_.time = message->header.stamp.toSec();
  shown_ = message;
  const bool first = scene_.sets.empty() != scene.sets.empty();
  scene_ = std::move(scene);
  if (first) changeLegend();
}

/// The frame of the message may move against the fixed frame also while no message comes.
void SutureDisplay::place() {
  Ogre::Vector3 position;
  Ogre::Quaternion orientation;
  const std::string& frame = shown_->header.frame_id;
  const bool known = context_->getFrameManager()->getTransform(frame, ros::Time(), position, orientation);
  const bool news = !placed_ || *placed_ != known;
  placed_ = known;
  if (!known) {
    scene_node_->setVisible(false);
    if (news)
      setStatusStd(StatusProperty::Error, kStatusTransform,
                   "There is no transform from '" + frame + "' to '" + fixed_frame_.toStdString() +
                       "'; choose another fixed frame or publish it.");
    return;
  }
  if (news) {
    setStatus(StatusProperty::Ok, kStatusTransform, "Known.");
    scene_node_->setVisible(true);
  }
  scene_node_->setPosition(position);
  scene_node_->setOrientation(orientation);
}

void SutureDisplay::draw() {
  shape_.clear();
  appendSutures(scene_, style_, shape_);
  visual_->showSolids(shape_);
  shape_.clear();
  appendLinks(scene_, style_, shape_);
  visual_->showSigns(shape_);
  drawLabels();
}

void SutureDisplay::drawLabels() {
  const double height = label_height_property_->getFloat();
  std::vector<SutureLabel> labels;
  for (std::size_t k = 0; k < scene_.sets.size() && label_property_->getBool(); ++k)
    if (!scene_.sets[k].bites.empty())
      labels.push_back({labelOf(scene_.sets[k], k), ogreOf(labelPlace(scene_.sets[k], 2 * height))});
  visual_->showLabels(labels, height);
}

void SutureDisplay::drawBlood() {
  shape_.clear();
  if (bleeding_property_->getBool()) appendBlood(scene_, blood_style_, shape_);
  visual_->showBlood(shape_);
}

}  // namespace vibe

PLUGINLIB_EXPORT_CLASS(vibe::SutureDisplay, rviz::Display)
