#pragma once
#include <QWidget>

#include "messages/procedure_text.hpp"

namespace vibe::rviz_plugins {

/// The procedure's phases from left to right. The present one is filled, framed and bold, those behind are
/// underlined.
class PhaseStrip : public QWidget {
 public:
  explicit PhaseStrip(QWidget* parent = nullptr);

  void display(const std::array<PhaseStep, kPhaseCount>& steps);
  QSize sizeHint() const override;
  QSize minimumSizeHint() const override;

 protected:
  void paintEvent(QPaintEvent* event) override;

 private:
  std::array<PhaseStep, kPhaseCount> steps_;

  double minWidth(const QFont& face) const;  // without clipping [px]
  QFont fittingFont() const;                 // smaller where there is no room for the whole
  void paintStep(QPainter& painter, const QRectF& place, const PhaseStep& step) const;
};

}  // namespace vibe::rviz_plugins
