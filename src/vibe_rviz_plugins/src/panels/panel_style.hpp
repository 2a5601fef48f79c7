#pragma once

#include <QColor>
#include <QIcon>
#include <QPalette>
#include <QString>
#include <map>

#include "vibe_operator/messages/reference_values.hpp"
#include "vibe_operator/messages/table_rows.hpp"

class QGridLayout;
class QLabel;
class QWidget;

namespace vibe::rviz_plugins {

/// Colours and symbols of the panel, legible with light and dark styles. No meaning depends on colour alone: every
/// symbol has its own shape.

QColor goodColour(const QPalette& palette);
QColor warningColour(const QPalette& palette);
QColor dangerColour(const QPalette& palette);
QColor quietColour(const QPalette& palette);

QColor colourOf(operating::EventSeverity severity, const QPalette& palette);
QColor colourOf(operating::Rating rating, const QPalette& palette);

/// Circle: note; tick: success; triangle: warning; drop: bleeding; cross in a square: harm.
QIcon symbolOf(operating::EventSeverity severity, const QPalette& palette);

/// A lamp, filled while it is on.
QIcon lamp(bool on, const QPalette& palette);

/// Two columns of labels: names and current values. Long values wrap.
class TextRows {
 public:
  /// Rows are added below the present contents of the layout.
  explicit TextRows(QGridLayout* layout) : layout_(layout) {}

  void add(const QString& name, const QString& help);
  /// Adds the row if there is none with this name.
  void set(const QString& name, const QString& value, const QString& help = {});
  /// Shows the value in bold in the colour of a warning; the row must exist.
  void mark(const QString& name, bool warns);
  QLabel* value(const QString& name) const;

 private:
  QGridLayout* layout_;
  std::map<QString, QLabel*> values_;
};

/// A label that wraps, can be selected with the mouse and never requests more width than it gets.
QLabel* wrappingLabel(QWidget* parent = nullptr);

/// Makes the font a little smaller, for secondary information in a narrow dock. Call it before the children are made.
void makeSmaller(QWidget& widget);

/// Converts text of a message to Qt; it is shown literally and not interpreted as HTML.
inline QString toQt(const std::string& text) {
  return QString::fromStdString(text);
}

}  // namespace vibe::rviz_plugins
