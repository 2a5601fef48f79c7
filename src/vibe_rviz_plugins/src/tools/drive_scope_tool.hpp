#pragma once
#ifndef Q_MOC_RUN
#include <rviz/tool.h>

#include <QPointer>
#include <QWidget>
#include <map>
#include <memory>
#include <string>

#include "overlay/drive_overlay.hpp"
#include "vibe_operator/driving/manual_drive.hpp"
#endif

class QTimer;

namespace rviz {
class BoolProperty;
class FloatProperty;
class StringProperty;
}  // namespace rviz

namespace vibe::rviz_plugins {

class Legend;

/// Drives the scope and the suturing device with keys and mouse in the render window, with an overlay that explains
/// the keys. Publishes only while it is the active tool.
class DriveScopeTool : public rviz::Tool {
  Q_OBJECT

 public:
  DriveScopeTool();
  ~DriveScopeTool() override;

  void onInitialize() override;
  void activate() override;
  void deactivate() override;
  void update(float wall_dt, float ros_dt) override;
  void load(const rviz::Config& config) override;
  int processMouseEvent(rviz::ViewportMouseEvent& event) override;
  /// Of the render window: rviz passes no key releases to tools.
  bool eventFilter(QObject* watched, QEvent* event) override;

 private Q_SLOTS:
  void connectAgain();
  void changeSpeeds();
  void changeHelp();
  void tickButtons();

 private:
  void makeProperties();
  rviz::FloatProperty* makeSpeed(const char* name, double value, const char* help, double most);
  bool handleKey(const QKeyEvent& event);
  bool isOurs(const QKeyEvent& event) const;
  void showNextView();
  DriveHud hudOf(const operating::DriveView& view) const;
  void draw(const DriveHud& hud);
  void hideOverlay();

  rviz::StringProperty* namespace_;
  rviz::BoolProperty *at_start_, *help_;
  std::array<rviz::FloatProperty*, 6> speeds_{};
  rviz::FloatProperty *slow_, *fast_, *bend_, *wheel_;

  operating::ManualDrive drive_;
  std::map<quint32, int> pressed_;  // keys by the code of their place, which Shift and layouts leave as it is
  QTimer* button_timer_;
  std::unique_ptr<Legend> banner_, keys_, state_;
  int view_ = 0;              // the saved view that was chosen last
  QPointer<QWidget> window_;  // whose keys it hears while it is active
  double drawn_ = 0;          // time of the last overlay, steady clock [s]
  bool active_ = false;
};

}  // namespace vibe::rviz_plugins
