#pragma once
#include <QWidget>
#include <vector>

#include "panels/panel_messages.hpp"

class QLabel;

namespace vibe::rviz_plugins {

class RangeBar;

/// Measures of skill, each with its value and, where a reference is published, with a bar. The tool tips name the
/// sources.
class MeasuresView : public QWidget {
 public:
  explicit MeasuresView(QWidget* parent = nullptr);

  void display(const PanelMessages& messages);

 private:
  struct Row {
    QLabel* value;
    RangeBar* bar;  // null: no reference
  };
  std::vector<Row> rows_;  // as measures()
};

}  // namespace vibe::rviz_plugins
