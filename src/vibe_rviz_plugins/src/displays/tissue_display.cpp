#include <OgreSceneNode.h>
#include <ros/subscriber.h>
#include <rviz/display.h>
#include <rviz/display_context.h>
#include <rviz/properties/bool_property.h>
#include <rviz/properties/color_property.h>
#include <rviz/properties/enum_property.h>
#include <rviz/properties/float_property.h>
#include <rviz/properties/ros_topic_property.h>
#include <sensor_msgs/PointCloud2.h>
#include <vibe_msgs/TissueTopology.h>
#include <memory>
#include <pluginlib/class_list_macros.hpp>

#include "overlay/legend.hpp"
#include "vibe_graphics/geometry/tissue_mesh.hpp"
#include "vibe_graphics/graphics/tissue_visual.hpp"
#include "vibe_graphics/messages/tissue_messages.hpp"
#include "vibe_rviz_plugins/display_base/topic_display.hpp"

namespace vibe::rviz_plugins {
namespace {

using rviz::StatusProperty;

// Default range of a colouring, in its unit.
struct Range {
  float min, max;
};
Range defaultRange(graphics::Colouring colouring) {
  switch (colouring) {
    case graphics::Colouring::Heat:
      return {0, 80};
    case graphics::Colouring::Thickness:
      return {0.002F, 0.006F};
    default:
      return {0, 0.5F};
  }
}

bool hasRange(graphics::Colouring colouring) {
  return colouring == graphics::Colouring::Strain || colouring == graphics::Colouring::Heat ||
         colouring == graphics::Colouring::Thickness;
}

QImage legendOf(graphics::Colouring colouring, const graphics::ColourMap& map) {
  const auto list = [](const char* title, const std::vector<graphics::PackedColour>& colours,
                       const std::vector<std::string>& names) {
    std::vector<LegendEntry> entries;
    for (std::size_t k = 0; k < names.size(); ++k) entries.push_back({colours[k], names[k]});
    return drawnLegend(title, entries);
  };
  switch (colouring) {
    case graphics::Colouring::Region:
      return list("Region", graphics::regionColours(), {"cardia", "fundus", "body", "antrum", "pylorus"});
    case graphics::Colouring::Wall:
      return list("Wall", graphics::wallColours(), {"anterior", "greater curvature", "posterior", "lesser curvature"});
    case graphics::Colouring::Seen:
      return list("Seen by the lens", graphics::seenColours(), {"not seen", "seen"});
    case graphics::Colouring::Heat:
      return drawnLegend("Heat [J]", map);
    case graphics::Colouring::Thickness:
      return drawnLegend("Thickness [m]", map);
    default:
      return drawnLegend("Strain", map);
  }
}

rviz::FloatProperty* bounded(rviz::FloatProperty* property, float min, float max) {
  property->setMin(min);
  property->setMax(max);
  return property;
}

}  // namespace

/// Draws the organ of tissue/topology with the positions of tissue/particles. Only the latest message is drawn, at most
/// once per frame of rviz, so a flood of messages does not slow it down.
class TissueDisplay : public rviz::Display {
  Q_OBJECT
 public:
  TissueDisplay() {
    addTopics();
    addColours();
    addSurface();
    addParts();
  }

  ~TissueDisplay() override { unsubscribe(); }

  void setTopic(const QString& topic, const QString&) override {
    topology_topic_->setString(topic);
    QString particles = topic;
    if (particles.endsWith("topology"))
      particles_topic_->setString(particles.replace(topic.size() - 8, 8, "particles"));
  }

  void update(float, float) override {
    if (latest_ && has_mesh_ && visual_) drawLatest();
  }

  void reset() override {
    Display::reset();
    latest_.reset();
    has_mesh_ = false;
    frames_ = 0;
    if (visual_) visual_->clear();
    if (isEnabled()) subscribe();  // the topology is latched: it comes again
  }

 protected:
  void onInitialize() override {
    try {
      visual_ = std::make_unique<graphics::TissueVisual>(*scene_node_);
    } catch (const std::exception& error) {
      setStatusStd(StatusProperty::Error, "Materials", error.what());
    }
    changeColouring();
  }

  void onEnable() override { subscribe(); }

  void onDisable() override {
    unsubscribe();
    reset();
    changeLegend();
  }

  void fixedFrameChanged() override { reset(); }

 private Q_SLOTS:
  void subscribe() {
    unsubscribe();
    if (!isEnabled() || !visual_) return;
    try {
      topology_subscriber_ =
          update_nh_.subscribe(topology_topic_->getTopicStd(), 2, &TissueDisplay::takeTopology, this);
      particles_subscriber_ =
          update_nh_.subscribe(particles_topic_->getTopicStd(), 1, &TissueDisplay::takeParticles, this);
      reportWaiting();
    } catch (const ros::Exception& error) {
      setStatusStd(StatusProperty::Error, "Topic", std::string("Cannot subscribe: ") + error.what() + ".");
    }
  }

  void changeColouring() {
    const auto colouring = static_cast<graphics::Colouring>(colouring_->getOptionInt());
    const bool ranged = hasRange(colouring);
    const Range range = defaultRange(colouring);
    map_->setHidden(!ranged), min_->setHidden(!ranged), max_->setHidden(!ranged);
    if (ranged)
      min_->setFloat(range.min), max_->setFloat(range.max);  // a loaded configuration sets its own range afterwards
    changeLook();
  }

  void changeLook() {
    if (!visual_) return;
    graphics::TissueLook look;
    look.surface = surface_->getBool();
    look.colouring = static_cast<graphics::Colouring>(colouring_->getOptionInt());
    look.map = map_->getStdString();
    look.min = static_cast<double>(min_->getFloat());
    look.max = static_cast<double>(max_->getFloat());
    look.inside = inside_->getOgreColor();
    look.outside = outside_->getOgreColor();
    look.outside_alpha = static_cast<double>(outside_alpha_->getFloat());
    look.wetness = static_cast<double>(wetness_->getFloat());
    look.relief = static_cast<double>(relief_->getFloat());
    look.scars = scars_->getBool();
    look.smoke = smoke_->getBool();
    look.particles = particles_->getBool();
    look.particle_size = static_cast<double>(particle_size_->getFloat());
    look.mesh = simulation_mesh_->getBool();
    visual_->setLook(look);
    changeLegend();
    context_->queueRender();
  }

  void changeLegend() {
    if (!visual_) return;
    const auto colouring = static_cast<graphics::Colouring>(colouring_->getOptionInt());
    if (!isEnabled() || !legend_shown_->getBool() || colouring == graphics::Colouring::Tissue) {
      if (legend_) legend_->hide();
      return;
    }
    if (!legend_) legend_ = std::make_unique<Legend>(Legend::Place::BottomLeft);
    const graphics::ColourMap map(map_->getStdString(), static_cast<double>(min_->getFloat()),
                                  static_cast<double>(max_->getFloat()));
    legend_->show(legendOf(colouring, map));
  }

 private:
  void addTopics() {
    topology_topic_ = new rviz::RosTopicProperty(
        "Topology Topic", "tissue/topology",
        QString::fromStdString(ros::message_traits::datatype<vibe_msgs::TissueTopology>()),
        "Topic of type vibe_msgs/TissueTopology: the mesh and its anatomy.", this, SLOT(subscribe()), this);
    particles_topic_ = new rviz::RosTopicProperty(
        "Particles Topic", "tissue/particles",
        QString::fromStdString(ros::message_traits::datatype<sensor_msgs::PointCloud2>()),
        "Topic of type sensor_msgs/PointCloud2: current positions of the particles of this mesh.", this,
        SLOT(subscribe()), this);
  }

  void addColours() {
    colouring_ =
        new rviz::EnumProperty("Colour by", "Tissue",
                               "What the colour of the surface shows: natural tissue, region, wall, strain, heat "
                               "received, wall thickness, or what the lens has seen in a scene with inspection.",
                               this, SLOT(changeColouring()), this);
    colouring_->addOption("Tissue", static_cast<int>(graphics::Colouring::Tissue));
    colouring_->addOption("Region", static_cast<int>(graphics::Colouring::Region));
    colouring_->addOption("Wall", static_cast<int>(graphics::Colouring::Wall));
    colouring_->addOption("Strain", static_cast<int>(graphics::Colouring::Strain));
    colouring_->addOption("Heat", static_cast<int>(graphics::Colouring::Heat));
    colouring_->addOption("Thickness", static_cast<int>(graphics::Colouring::Thickness));
    colouring_->addOption("Seen", static_cast<int>(graphics::Colouring::Seen));
    map_ = new rviz::EnumProperty("Colour map", "viridis",
                                  "Perceptually uniform map from values to colours; cividis looks the same with "
                                  "and without colour vision deficiency.",
                                  colouring_, SLOT(changeLook()), this);
    int number = 0;
    for (const std::string& name : graphics::colourMapNames()) map_->addOption(QString::fromStdString(name), number++);
    const Range range = defaultRange(graphics::Colouring::Strain);
    min_ =
        new rviz::FloatProperty("From", range.min, "Value at the dark end of the map: strain, heat [J], thickness [m].",
                                colouring_, SLOT(changeLook()), this);
    max_ =
        new rviz::FloatProperty("To", range.max, "Value at the bright end of the map: strain, heat [J], thickness [m].",
                                colouring_, SLOT(changeLook()), this);
    legend_shown_ =
        new rviz::BoolProperty("Legend", true, "Show the colour scale in the lower left corner of the views.",
                               colouring_, SLOT(changeLegend()), this);
  }

  void addSurface() {
    surface_ =
        new rviz::BoolProperty("Surface", true, "Draw the surface of the organ.", this, SLOT(changeLook()), this);
    inside_ = new rviz::ColorProperty("Inside", QColor(219, 120, 107), "Colour of the mucosa, which lines the inside.",
                                      surface_, SLOT(changeLook()), this);
    outside_ =
        new rviz::ColorProperty("Outside", QColor(214, 158, 143), "Colour of the serosa, which covers the outside.",
                                surface_, SLOT(changeLook()), this);
    outside_alpha_ = bounded(
        new rviz::FloatProperty("Outside opacity", 0.15F,
                                "Opacity of the wall seen head-on from outside: 0 shows the inside only, 1 hides it.",
                                surface_, SLOT(changeLook()), this),
        0, 1);
    wetness_ = bounded(new rviz::FloatProperty("Wetness", 0.4F, "Strength of highlights: 0 is dull, 1 very wet.",
                                               surface_, SLOT(changeLook()), this),
                       0, 1);
    relief_ =
        bounded(new rviz::FloatProperty("Relief", 0.0006F,
                                        "Height of the fine relief of the mucosa [m]; it is shading, not geometry.",
                                        surface_, SLOT(changeLook()), this),
                0, 0.01F);
    scars_ = new rviz::BoolProperty(
        "Marks and burns", true,
        "Show the effects of the argon beam on the inside: pale marks, brown burn scars, black where the "
        "muscularis is at risk.",
        surface_, SLOT(changeLook()), this);
    smoke_ = new rviz::BoolProperty(
        "Smoke", true, "In the view Endoscope, show the smoke of the argon beam, which clears within a minute.",
        surface_, SLOT(changeLook()), this);
  }

  void addParts() {
    particles_ = new rviz::BoolProperty("Particles", false, "Draw the simulated particles as balls.", this,
                                        SLOT(changeLook()), this);
    particle_size_ = bounded(
        new rviz::FloatProperty("Diameter", 0.003F, "Diameter of the balls [m].", particles_, SLOT(changeLook()), this),
        0.0001F, 0.1F);
    simulation_mesh_ =
        new rviz::BoolProperty("Simulation mesh", false,
                               "Draw the edges of the simulation mesh, whose particles determine the render surface.",
                               this, SLOT(changeLook()), this);
  }

  void unsubscribe() {
    topology_subscriber_.shutdown();
    particles_subscriber_.shutdown();
  }

  void takeTopology(const vibe_msgs::TissueTopology::ConstPtr& message) {
    graphics::TissueMesh mesh;
    const std::string wrong = graphics::readTopology(*message, mesh);
    if (!wrong.empty()) {
      setStatusStd(StatusProperty::Error, "Topology", wrong);
      return;
    }
    mesh_ = std::move(mesh);
    has_mesh_ = true;
    visual_->setMesh(mesh_);
    setStatusStd(StatusProperty::Ok, "Topology",
                 mesh_.name + ", revision " + std::to_string(mesh_.revision) + ": " +
                     std::to_string(mesh_.particle_count) + " particles, " +
                     std::to_string(mesh_.triangles.size() / 3) + " triangles drawn.");
  }

  void takeParticles(const sensor_msgs::PointCloud2::ConstPtr& message) { latest_ = message; }

  void drawLatest() {
    const sensor_msgs::PointCloud2::ConstPtr message = std::move(latest_);
    latest_.reset();
    const std::string wrong = graphics::readParticles(*message, mesh_, frame_);
    if (!wrong.empty()) {
      reportError("Particles", wrong);
      return;
    }
    if (!place(message->header)) return;
    visual_->setFrame(frame_);
    if (frames_++ == 0 || has_error_) {  // not for every frame: setting a status costs more than drawing
      setStatus(StatusProperty::Ok, "Particles", "The latest message is drawn.");
      setStatus(StatusProperty::Ok, "Transform", "Known.");
      has_error_ = false;
    }
    context_->queueRender();
  }

  bool place(const std_msgs::Header& header) {
    FramePose pose;
    const std::string wrong = lookUpFrame(*context_, header.frame_id, header.stamp, pose);
    if (!wrong.empty()) {
      reportError("Transform", wrong);
      return false;
    }
    scene_node_->setPosition(pose.position);
    scene_node_->setOrientation(pose.orientation);
    return true;
  }

  void reportWaiting() {
    if (!has_mesh_)
      setStatusStd(StatusProperty::Warn, "Topology",
                   "No message on " + topology_topic_->getTopicStd() + " yet; is the simulator running?");
    if (frames_ == 0)
      setStatusStd(StatusProperty::Warn, "Particles", "No message on " + particles_topic_->getTopicStd() + " yet.");
  }

  void reportError(const std::string& about, const std::string& text) {
    has_error_ = true;
    setStatusStd(StatusProperty::Error, about, text);
  }

  rviz::RosTopicProperty *topology_topic_, *particles_topic_;
  rviz::EnumProperty *colouring_, *map_;
  rviz::FloatProperty *min_, *max_, *outside_alpha_, *wetness_, *relief_, *particle_size_;
  rviz::BoolProperty *legend_shown_, *surface_, *scars_, *smoke_, *particles_, *simulation_mesh_;
  rviz::ColorProperty *inside_, *outside_;

  ros::Subscriber topology_subscriber_, particles_subscriber_;
  sensor_msgs::PointCloud2::ConstPtr latest_;  // not drawn yet
  graphics::TissueMesh mesh_;
  graphics::TissueFrame frame_;
  bool has_mesh_ = false, has_error_ = false;
  std::size_t frames_ = 0;
  std::unique_ptr<graphics::TissueVisual> visual_;
  std::unique_ptr<Legend> legend_;
};

}  // namespace vibe::rviz_plugins

PLUGINLIB_EXPORT_CLASS(vibe::rviz_plugins::TissueDisplay, rviz::Display)

#include "tissue_display.moc"
