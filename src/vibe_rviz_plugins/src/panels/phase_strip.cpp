#include "panels/phase_strip.hpp"

#include <QFontInfo>
#include <QFontMetrics>
#include <QPainter>
#include <algorithm>

#include "panels/panel_colours.hpp"

namespace vibe::rviz_plugins {
namespace {

constexpr double kGap = 3;          // between two steps [px]
constexpr double kRound = 4;        // radius of corners [px]
constexpr double kSmallest = 0.75;  // of the font, where the dock is narrow
constexpr int kStepMargin = 10;     // of a step's height besides its text [px]
constexpr int kSideMargin = 4;      // left and right of a step's text [px]

QFont bold(QFont font) {
  font.setBold(true);
  return font;
}

double widthOf(const PhaseStep& step, const QFont& face) {
  return QFontMetrics(bold(face)).horizontalAdvance(QString::fromStdString(step.name)) + 2 * kSideMargin;
}

}  // namespace

PhaseStrip::PhaseStrip(QWidget* parent) : QWidget(parent), steps_(phaseSteps("")) {
  setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Fixed);
  setToolTip("Phase of the procedure; it follows from what is done.");
}

void PhaseStrip::display(const std::array<PhaseStep, kPhaseCount>& steps) {
  steps_ = steps;
  QString present = "Phase unknown";
  for (const PhaseStep& step : steps_)
    if (step.kind == StepKind::Present) present = "Phase: " + QString::fromStdString(step.name);
  setAccessibleName(present);
  update();
}

double PhaseStrip::minWidth(const QFont& face) const {
  double width = kGap * (kPhaseCount - 1);
  for (const PhaseStep& step : steps_) width += widthOf(step, face);
  return width;
}

QSize PhaseStrip::sizeHint() const {
  return {static_cast<int>(minWidth(font())) + 1, QFontMetrics(bold(font())).height() + kStepMargin};
}

QSize PhaseStrip::minimumSizeHint() const {
  return {static_cast<int>(kSmallest * minWidth(font())) + 1, sizeHint().height()};
}

QFont PhaseStrip::fittingFont() const {
  QFont face = font();
  const double share = std::max(kSmallest, std::min(1.0, width() / minWidth(face)));
  face.setPointSizeF(share * QFontInfo(face).pointSizeF());
  return face;
}

void PhaseStrip::paintEvent(QPaintEvent*) {
  QPainter painter(this);
  painter.setRenderHint(QPainter::Antialiasing);
  const QFont face = fittingFont();
  const double extra = (width() - minWidth(face)) / kPhaseCount;
  double left = 0;
  for (const PhaseStep& step : steps_) {
    const double width = widthOf(step, face) + extra;
    painter.setFont(step.kind == StepKind::Present ? bold(face) : face);
    paintStep(painter, QRectF(left + 1, 1, width - 2, height() - 2), step);
    left += width + kGap;
  }
}

void PhaseStrip::paintStep(QPainter& painter, const QRectF& place, const PhaseStep& step) const {
  const bool present = step.kind == StepKind::Present;
  const QColor quiet = quietColour(palette());
  painter.setPen(QPen(present ? palette().color(QPalette::Text) : quiet, present ? 2 : 1));
  painter.setBrush(present ? palette().brush(QPalette::Highlight) : QBrush(Qt::NoBrush));
  painter.drawRoundedRect(place, kRound, kRound);
  if (step.kind == StepKind::Before) {
    // a line below what is behind
    painter.setPen(QPen(goodColour(palette()), 3));
    painter.drawLine(place.bottomLeft() + QPointF(kRound, -2), place.bottomRight() + QPointF(-kRound, -2));
  }
  painter.setPen(palette().color(present ? QPalette::HighlightedText : QPalette::WindowText));
  painter.drawText(place, Qt::AlignCenter, QString::fromStdString(step.name));
}

}  // namespace vibe::rviz_plugins
