#include "rviz_events.hpp"

#include <rviz/render_panel.h>
#include <rviz/tool.h>
#include <rviz/tool_manager.h>
#include <rviz/view_manager.h>
#include <rviz/visualization_manager.h>
#include <unistd.h>

#include <QCoreApplication>
#include <QKeyEvent>
#include <QMetaEnum>
#include <QMouseEvent>
#include <QWheelEvent>
#include <cstdio>
#include <cstdlib>

namespace vibe::rviz_plugins {
namespace {

constexpr int kNotch = 120;    // [eighths of a degree]
constexpr int kDragMoves = 5;  // of a drag

void fail(const QString& sentence) {
  std::fprintf(stderr, "rviz_report: %s\n", sentence.toUtf8().constData());
  std::exit(2);
}

}  // namespace

RvizEvents::RvizEvents(rviz::VisualizationManager& manager)
    : manager_(manager), notifier_(STDIN_FILENO, QSocketNotifier::Read) {
  QObject::connect(&notifier_, &QSocketNotifier::activated, [this] { read(); });
}

void RvizEvents::read() {
  char bytes[4096];
  const ssize_t count = ::read(STDIN_FILENO, bytes, sizeof bytes);
  if (count <= 0) return notifier_.setEnabled(false);
  unread_.append(bytes, static_cast<int>(count));
  for (auto end = unread_.indexOf('\n'); end >= 0; end = unread_.indexOf('\n')) {
    const QString line = QString::fromUtf8(unread_.left(end)).trimmed();
    unread_.remove(0, end + 1);
    act(line.section(' ', 0, 0), line.section(' ', 1));
  }
}

void RvizEvents::act(const QString& command, const QString& argument) {
  if (command == "down") return sendKey(QEvent::KeyPress, argument, false);
  if (command == "repeat") return sendKey(QEvent::KeyPress, argument, true);
  if (command == "up") return sendKey(QEvent::KeyRelease, argument, false);
  if (command == "click") {
    sendKey(QEvent::KeyPress, argument, false);
    return sendKey(QEvent::KeyRelease, argument, false);
  }
  if (command == "drag") return drag({argument.section(' ', 0, 0).toInt(), argument.section(' ', 1, 1).toInt()});
  if (command == "wheel") return turnWheel(argument.toDouble());
  if (command == "tool") return chooseTool(argument);
  if (command == "focus_in") return takeFocus();
  if (command != "focus_out") return fail("there is no command '" + command + "'");
  QFocusEvent event(QEvent::FocusOut, Qt::ActiveWindowFocusReason);
  QCoreApplication::sendEvent(manager_.getViewManager()->getRenderPanel(), &event);
}

void RvizEvents::sendKey(int type, const QString& name, bool repeated) {
  bool known = false;
  const QString key_name = name.section(' ', 0, 0);  // behind it the scan code, if it matters
  const int key = QMetaEnum::fromType<Qt::Key>().keyToValue(key_name.toUtf8().constData(), &known);
  if (!known) return fail("there is no key '" + name + "'");
  QKeyEvent event(static_cast<QEvent::Type>(type), key, Qt::NoModifier, name.section(' ', 1).toUInt(), 0, 0, QString(),
                  repeated);
  QCoreApplication::sendEvent(manager_.getViewManager()->getRenderPanel(), &event);
}

void RvizEvents::drag(const QPoint& by) {
  rviz::RenderPanel* panel = manager_.getViewManager()->getRenderPanel();
  const QPoint begin = panel->rect().center();
  const auto send = [&](QEvent::Type type, const QPoint& place, Qt::MouseButton button, Qt::MouseButtons down) {
    QMouseEvent event(type, place, panel->mapToGlobal(place), button, down, Qt::NoModifier);
    QCoreApplication::sendEvent(panel, &event);
  };
  send(QEvent::MouseMove, begin, Qt::NoButton, Qt::NoButton);
  send(QEvent::MouseButtonPress, begin, Qt::LeftButton, Qt::LeftButton);
  for (int i = 1; i <= kDragMoves; ++i)
    send(QEvent::MouseMove, begin + by * i / kDragMoves, Qt::NoButton, Qt::LeftButton);
  send(QEvent::MouseButtonRelease, begin + by, Qt::LeftButton, Qt::NoButton);
}

void RvizEvents::turnWheel(double notches) {
  rviz::RenderPanel* panel = manager_.getViewManager()->getRenderPanel();
  const QPoint place = panel->rect().center(), turn(0, static_cast<int>(notches * kNotch));
  QWheelEvent event(place, panel->mapToGlobal(place), QPoint(), turn, Qt::NoButton, Qt::NoModifier, Qt::NoScrollPhase,
                    false);
  QCoreApplication::sendEvent(panel, &event);
}

void RvizEvents::takeFocus() {
  rviz::RenderPanel* panel = manager_.getViewManager()->getRenderPanel();
  panel->window()->activateWindow();  // a display without a window manager gives the keyboard to no window
  panel->setFocus();
}

void RvizEvents::chooseTool(const QString& name) {
  rviz::ToolManager& tools = *manager_.getToolManager();
  for (int i = 0; i < tools.numTools(); ++i)
    if (tools.getTool(i)->getName() == name) return tools.setCurrentTool(tools.getTool(i));
  fail("there is no tool '" + name + "'");
}

}  // namespace vibe::rviz_plugins
