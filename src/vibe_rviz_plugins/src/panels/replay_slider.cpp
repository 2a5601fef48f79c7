#include "panels/replay_slider.hpp"

#include <QHelpEvent>
#include <QMouseEvent>
#include <QPainter>
#include <QToolTip>
#include <algorithm>
#include <cmath>

namespace vibe::rviz_plugins {
namespace {

constexpr int kHandleMargin = 8;     // at both ends, for the handle [px]
constexpr int kTop = 22, kBar = 10;  // below the names of the phases; height of the bar [px]
constexpr int kNear = 4;             // of a mark, for its text [px]

}  // namespace

ReplaySlider::ReplaySlider(Seek seek, QWidget* parent) : QWidget(parent), seek_(std::move(seek)) {
  setObjectName("slider");
  setCursor(Qt::PointingHandCursor);
}

void ReplaySlider::display(double time, double duration, std::vector<Mark> marks) {
  duration_ = duration;
  if (!dragged_) time_ = time;
  marks_ = std::move(marks);
  update();
}

double ReplaySlider::timeAt(int x) const {
  const double share = static_cast<double>(x - kHandleMargin) / std::max(1, width() - 2 * kHandleMargin);
  return std::clamp(share, 0.0, 1.0) * duration_;
}

int ReplaySlider::placeOf(double time) const {
  const double share = duration_ > 0 ? std::clamp(time / duration_, 0.0, 1.0) : 0;
  return kHandleMargin + static_cast<int>(std::lround(share * (width() - 2 * kHandleMargin)));
}

void ReplaySlider::paintEvent(QPaintEvent*) {
  QPainter painter(this);
  painter.setRenderHint(QPainter::Antialiasing);
  const QRect bar(kHandleMargin, kTop, width() - 2 * kHandleMargin, kBar);
  painter.setPen(Qt::NoPen);
  painter.setBrush(palette().color(QPalette::Mid));
  painter.drawRoundedRect(bar, 3, 3);
  painter.setBrush(palette().color(QPalette::Highlight));
  painter.drawRoundedRect(QRect(bar.left(), bar.top(), placeOf(time_) - bar.left(), kBar), 3, 3);
  int free_from = 0;  // where the name of a phase does not cover another one
  for (const Mark& mark : marks_) {
    const int x = placeOf(mark.time);
    painter.setPen(QPen(palette().color(QPalette::WindowText), mark.is_phase ? 2 : 1));
    painter.drawLine(x, mark.is_phase ? kTop - 6 : kTop + kBar, x, mark.is_phase ? kTop + kBar : kTop + kBar + 6);
    if (!mark.is_phase || x < free_from) continue;
    painter.drawText(std::min(x, width() - fontMetrics().horizontalAdvance(mark.text)), kTop - 8, mark.text);
    free_from = x + fontMetrics().horizontalAdvance(mark.text + "  ");
  }
  painter.setPen(QPen(palette().color(QPalette::WindowText), 1));
  painter.setBrush(palette().color(QPalette::Button));
  painter.drawEllipse(QPoint(placeOf(time_), kTop + kBar / 2), 6, 6);
}

void ReplaySlider::drag(int x, bool exact) {
  time_ = timeAt(x);
  update();
  seek_(time_, exact);
}

void ReplaySlider::mousePressEvent(QMouseEvent* event) {
  if (event->button() != Qt::LeftButton || !(duration_ > 0)) return;
  dragged_ = true;
  drag(event->x(), false);
}

void ReplaySlider::mouseMoveEvent(QMouseEvent* event) {
  if (dragged_) drag(event->x(), false);
}

void ReplaySlider::mouseReleaseEvent(QMouseEvent* event) {
  if (!dragged_ || event->button() != Qt::LeftButton) return;
  dragged_ = false;
  drag(event->x(), true);
}

bool ReplaySlider::event(QEvent* event) {
  if (event->type() != QEvent::ToolTip) return QWidget::event(event);
  const auto* help = static_cast<QHelpEvent*>(event);
  QString text = QString("%1 s").arg(timeAt(help->x()), 0, 'f', 1);
  for (const Mark& mark : marks_)
    if (std::abs(placeOf(mark.time) - help->x()) <= kNear)
      text += QString("\n%1 s: %2").arg(mark.time, 0, 'f', 1).arg(mark.text);
  QToolTip::showText(help->globalPos(), text, this);
  return true;
}

}  // namespace vibe::rviz_plugins
