#include "panels/range_bar.hpp"

#include <QPainter>

#include "panels/panel_colours.hpp"

namespace vibe::rviz_plugins {
namespace {

constexpr double kMark = 5;   // radius of the mark [px]
constexpr double kTrack = 3;  // half of the height of the band [px]

}  // namespace

RangeBar::RangeBar(QWidget* parent) : QWidget(parent) {
  setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Fixed);
}

void RangeBar::display(const BarShape& shape, Rating rating) {
  shape_ = shape;
  rating_ = rating;
  setAccessibleName(QString::fromStdString(ratingText(rating)));
  update();
}

void RangeBar::paintEvent(QPaintEvent*) {
  QPainter painter(this);
  painter.setRenderHint(QPainter::Antialiasing);
  const double left = kMark + 1, length = width() - 2 * left, y = 0.5 * height();
  const QColor quiet = quietColour(palette());
  painter.setPen(QPen(quiet, 1));
  painter.drawLine(QPointF(left, y), QPointF(left + length, y));
  if (shape_.has_range) {
    QColor band = goodColour(palette());
    band.setAlpha(110);
    const double begin = left + shape_.range_begin * length, end = left + shape_.range_end * length;
    // a range of one number is a band of a few pixels
    const QRectF place(begin - 1.5, y - kTrack, std::max(3.0, end - begin + 3), 2 * kTrack);
    painter.fillRect(place, band);
    painter.setPen(QPen(goodColour(palette()), 1));
    painter.drawRect(place);
  }
  if (shape_.has_value) paintMark(painter, left + shape_.value * length, y);
}

void RangeBar::paintMark(QPainter& painter, double x, double y) const {
  const QColor colour = colourOf(rating_, palette());
  painter.setPen(QPen(palette().color(QPalette::WindowText), 1));
  painter.setBrush(rating_ == Rating::Within || rating_ == Rating::Outside ? QBrush(colour)
                                                                           : palette().brush(QPalette::Window));
  if (shape_.beyond) {
    const double tip = shape_.value > 0.5 ? kMark : -kMark;
    painter.drawPolygon(QVector<QPointF>{{x - tip, y - kMark}, {x + tip, y}, {x - tip, y + kMark}});
  } else if (rating_ == Rating::Outside) {
    painter.drawPolygon(QVector<QPointF>{{x, y - kMark}, {x + kMark, y + kMark}, {x - kMark, y + kMark}});
  } else {
    painter.drawEllipse(QPointF(x, y), kMark - 1, kMark - 1);
  }
}

}  // namespace vibe::rviz_plugins
