#pragma once
#ifndef Q_MOC_RUN
#include <ros/node_handle.h>
#include <rviz/panel.h>
#include <vibe_msgs/ReplayStatus.h>
#endif

class QComboBox;
class QLabel;
class QPushButton;

namespace vibe::rviz_plugins {

class ReplaySlider;

/// Plays, pauses and scrubs a recording that vibe_player has open.
class ReplayPanel : public rviz::Panel {
  Q_OBJECT
 public:
  explicit ReplayPanel(QWidget* parent = nullptr);
  void onInitialize() override;

 private:
  ReplaySlider* slider_;
  QPushButton* play_;
  QComboBox* rate_;
  QLabel *time_, *state_;
  ros::Publisher commands_;
  ros::Subscriber statuses_;
  vibe_msgs::ReplayStatus status_;

  void display(const vibe_msgs::ReplayStatus& status);
  void command(bool play, double seek, bool exact);
  double rate() const;
};

}  // namespace vibe::rviz_plugins
