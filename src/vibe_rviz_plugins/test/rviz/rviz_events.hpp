#pragma once
#include <QPoint>
#include <QSocketNotifier>
#include <QString>
#include <QStringList>

namespace rviz {
class VisualizationManager;
}

namespace vibe::rviz_plugins {

/// Sends events to the render window of rviz, as they are read from standard input, one a line:
///   down KEY        a key goes down; KEY is the name of Qt, such as Key_W
///   repeat KEY      the keyboard repeats it
///   up KEY          it comes up
///   click KEY       down and up
///   focus_in        the window gets the keyboard
///   focus_out       the window loses the keyboard
///   drag DX DY      the left mouse button is pressed in the middle, moved by so many pixels and released
///   wheel NOTCHES   of the mouse; positive: away from the user
///   tool NAME       another tool is chosen in the toolbar
/// An unknown line ends the program with a sentence.
class RvizEvents {
 public:
  explicit RvizEvents(rviz::VisualizationManager& manager);

 private:
  rviz::VisualizationManager& manager_;
  QSocketNotifier notifier_;
  QByteArray unread_;

  void read();
  void act(const QString& command, const QString& argument);
  void sendKey(int type, const QString& name, bool repeated);
  void drag(const QPoint& by);
  void turnWheel(double notches);
  void takeFocus();
  void chooseTool(const QString& name);
};

}  // namespace vibe::rviz_plugins
