#pragma once
#include <QApplication>
#include <QImage>
#include <QLabel>
#include <QWidget>
#include <cstdlib>

namespace vibe::rviz_plugins {

/// The one application of a test program, without a display.
inline QApplication& offscreenApplication() {
  setenv("QT_QPA_PLATFORM", "offscreen", 1);
  static int argc = 1;
  static char name[] = "test";
  static char* argv[] = {name, nullptr};
  static QApplication application(argc, argv);
  return application;
}

/// The text of a label below a widget, found by its name; empty without one.
inline std::string textOf(const QWidget& widget, const QString& name) {
  const auto* label = widget.findChild<QLabel*>(name);
  return label ? label->text().toStdString() : std::string();
}

/// What a widget looks like at its present size.
inline QImage pictureOf(QWidget& widget) {
  QImage image(widget.size(), QImage::Format_ARGB32);
  image.fill(Qt::transparent);
  widget.render(&image, {}, {}, QWidget::DrawChildren);  // without a background, so that alpha tells the shape
  return image;
}

}  // namespace vibe::rviz_plugins
