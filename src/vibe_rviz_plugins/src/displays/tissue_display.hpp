#pragma once
#include <ros/subscriber.h>
#include <rviz/display.h>
#include <sensor_msgs/PointCloud2.h>
#include <vibe_msgs/TissueTopology.h>

#include <memory>

#include "vibe_graphics/geometry/tissue_mesh.hpp"

namespace rviz {
class BoolProperty;
class ColorProperty;
class EnumProperty;
class FloatProperty;
class RosTopicProperty;
}  // namespace rviz

namespace vibe::graphics {
class TissueVisual;
}

namespace vibe::rviz_plugins {

class Legend;

/// Draws the organ of tissue/topology with the positions of tissue/particles. Only the latest message is drawn, at most
/// once per frame of rviz, so a flood of messages does not slow it down.
class TissueDisplay : public rviz::Display {
  Q_OBJECT
 public:
  TissueDisplay();
  ~TissueDisplay() override;

  void setTopic(const QString& topic, const QString& datatype) override;
  void update(float wall_dt, float ros_dt) override;
  void reset() override;

 protected:
  void onInitialize() override;
  void onEnable() override;
  void onDisable() override;
  void fixedFrameChanged() override;

 private Q_SLOTS:
  void subscribe();
  void changeColouring();
  void changeLook();
  void changeLegend();

 private:
  void addTopics();
  void addColours();
  void addSurface();
  void addParts();
  void unsubscribe();
  void takeTopology(const vibe_msgs::TissueTopology::ConstPtr& message);
  void takeParticles(const sensor_msgs::PointCloud2::ConstPtr& message);
  void drawLatest();
  bool place(const std_msgs::Header& header);
  void reportWaiting();
  void reportError(const std::string& about, const std::string& text);

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
