#pragma once
#include <QString>
#include <map>

class QGridLayout;
class QLabel;
class QWidget;

namespace vibe {

/// Two columns of labels: what it is, and what it says now. Long values wrap.
class TextRows {
 public:
  /// Rows are added below what the layout has already.
  explicit TextRows(QGridLayout* layout) : layout_(layout) {}

  void add(const QString& name, const QString& help);
  /// Adds the row if there is none of this name.
  void set(const QString& name, const QString& value, const QString& help = {});
  /// Bold and in this colour's meaning; needs the row.
  void mark(const QString& name, bool warns);
  QLabel* value(const QString& name) const;

 private:
  QGridLayout* layout_;
  std::map<QString, QLabel*> values_;
};

/// A label that wraps, can be selected with the mouse and never asks for more width than it gets.
QLabel* wrappingLabel(QWidget* parent = nullptr);

/// A little smaller, for what is looked at more rarely and has to fit into a narrow dock. Before its children are made.
void makeSmaller(QWidget& widget);

/// The text of a message. Whatever it holds, it is shown as it is and not taken for HTML.
inline QString toQt(const std::string& text) {
  return QString::fromStdString(text);
}

}  // namespace vibe
