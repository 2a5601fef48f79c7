#pragma once

#include <QWidget>
#include <functional>
#include <vector>

#ifndef Q_MOC_RUN
#include <ros/node_handle.h>
#include <rviz/panel.h>
#include <vibe_msgs/ReplayStatus.h>
#endif

class QComboBox;
class QLabel;
class QPushButton;

namespace vibe::rviz_plugins {

/// The time of a recording as a bar: played part, marks, and a handle to drag.
class ReplaySlider : public QWidget {
 public:
  struct Mark {
    double time;  ///< [s]
    QString text;
    bool is_phase;
  };
  /// @param time   asked for [s]
  /// @param exact  false while the handle is dragged
  using Seek = std::function<void(double time, bool exact)>;

  explicit ReplaySlider(Seek seek, QWidget* parent = nullptr);

  /// @param time, duration  [s]
  void display(double time, double duration, std::vector<Mark> marks);
  QSize sizeHint() const override { return {400, 44}; }
  QSize minimumSizeHint() const override { return {160, 44}; }

 protected:
  void paintEvent(QPaintEvent* event) override;
  void mousePressEvent(QMouseEvent* event) override;
  void mouseMoveEvent(QMouseEvent* event) override;
  void mouseReleaseEvent(QMouseEvent* event) override;
  bool event(QEvent* event) override;

 private:
  Seek seek_;
  double time_ = 0, duration_ = 0;
  std::vector<Mark> marks_;
  bool dragged_ = false;

  double timeAt(int x) const;
  int placeOf(double time) const;
  void drag(int x, bool exact);
};

}  // namespace vibe::rviz_plugins
