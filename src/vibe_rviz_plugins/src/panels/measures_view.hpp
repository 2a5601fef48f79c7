#pragma once

#include <QWidget>
#include <memory>
#include <vector>

#include "panels/panel_messages.hpp"
#include "vibe_operator/messages/reference_values.hpp"

class QLabel;

namespace vibe::rviz_plugins {

/// A small horizontal bar: the published range as a band, the value as a mark on it. The mark is a filled circle within
/// the range, a triangle outside, an open circle without a range, and an arrow beyond the end of the bar.
class RangeBar : public QWidget {
 public:
  explicit RangeBar(QWidget* parent = nullptr);

  void display(const operating::BarShape& shape, operating::Rating rating);
  QSize sizeHint() const override { return {90, 16}; }
  QSize minimumSizeHint() const override { return {40, 16}; }

 protected:
  void paintEvent(QPaintEvent* event) override;

 private:
  operating::BarShape shape_;
  operating::Rating rating_ = operating::Rating::NoValue;

  void paintMark(QPainter& painter, double x, double y) const;
};

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

class TextRows;

/// Solver times, real-time factor and latency.
class SolverStatisticsView : public QWidget {
 public:
  explicit SolverStatisticsView(QWidget* parent = nullptr);
  ~SolverStatisticsView() override;

  void display(const PanelMessages& messages, const Freshness& freshness);

 private:
  std::unique_ptr<TextRows> rows_;
};

}  // namespace vibe::rviz_plugins
