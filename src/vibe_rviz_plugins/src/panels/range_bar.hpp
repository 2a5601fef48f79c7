#pragma once
#include <QWidget>

#include "messages/reference_values.hpp"

namespace vibe::rviz_plugins {

/// A small horizontal bar: the published range as a band, the value as a mark on it. The mark is a filled circle within
/// the range, a triangle outside, an open circle without a range, and an arrow beyond the end of the bar.
class RangeBar : public QWidget {
 public:
  explicit RangeBar(QWidget* parent = nullptr);

  void display(const BarShape& shape, Rating rating);
  QSize sizeHint() const override { return {90, 16}; }
  QSize minimumSizeHint() const override { return {40, 16}; }

 protected:
  void paintEvent(QPaintEvent* event) override;

 private:
  BarShape shape_;
  Rating rating_ = Rating::NoValue;

  void paintMark(QPainter& painter, double x, double y) const;
};

}  // namespace vibe::rviz_plugins
