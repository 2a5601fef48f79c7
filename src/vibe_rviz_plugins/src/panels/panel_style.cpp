#include "panels/panel_style.hpp"

#include <QFontInfo>
#include <QGridLayout>
#include <QLabel>
#include <QPainter>
#include <QPainterPath>
#include <QPixmap>

namespace vibe::rviz_plugins {

namespace {

constexpr int kSize = 32;  // drawn finer than shown, for dense screens [px]

bool isDark(const QPalette& palette) {
  return palette.color(QPalette::Window).lightness() < 128;
}

template <class Draw>
QIcon drawn(const QColor& colour, Draw draw) {
  QPixmap picture(kSize, kSize);
  picture.fill(Qt::transparent);
  QPainter painter(&picture);
  painter.setRenderHint(QPainter::Antialiasing);
  painter.setPen(QPen(colour, 4, Qt::SolidLine, Qt::RoundCap, Qt::RoundJoin));
  draw(painter);
  painter.end();
  // the same when the row is selected: Qt would tint it into one blot
  QIcon icon(picture);
  icon.addPixmap(picture, QIcon::Selected);
  icon.addPixmap(picture, QIcon::Disabled);
  return icon;
}

void drawTriangle(QPainter& painter) {
  painter.drawPolygon(QVector<QPointF>{{16, 3}, {30, 28}, {2, 28}});
  painter.drawLine(16, 12, 16, 19);
  painter.drawPoint(16, 24);
}

void drawDrop(QPainter& painter) {
  QPainterPath path(QPointF(16, 2));
  path.cubicTo(18, 10, 27, 14, 27, 20);
  path.cubicTo(27, 33, 5, 33, 5, 20);
  path.cubicTo(5, 14, 14, 10, 16, 2);
  painter.setBrush(painter.pen().color());
  painter.drawPath(path);
}

void drawCross(QPainter& painter) {
  painter.drawRect(3, 3, 26, 26);
  painter.drawLine(10, 10, 22, 22);
  painter.drawLine(22, 10, 10, 22);
}

void drawTick(QPainter& painter) {
  painter.drawPolyline(QVector<QPointF>{{4, 17}, {12, 26}, {28, 6}});
}

}  // namespace

QColor goodColour(const QPalette& palette) {
  return isDark(palette) ? QColor(129, 199, 132) : QColor(27, 110, 45);
}

QColor warningColour(const QPalette& palette) {
  return isDark(palette) ? QColor(255, 190, 90) : QColor(150, 80, 0);
}

QColor dangerColour(const QPalette& palette) {
  return isDark(palette) ? QColor(255, 138, 128) : QColor(183, 28, 28);
}

QColor quietColour(const QPalette& palette) {
  return isDark(palette) ? QColor(160, 160, 160) : QColor(110, 110, 110);
}

QColor colourOf(operating::EventSeverity severity, const QPalette& palette) {
  switch (severity) {
    case operating::EventSeverity::Success:
      return goodColour(palette);
    case operating::EventSeverity::Warning:
      return warningColour(palette);
    case operating::EventSeverity::Bleeding:
    case operating::EventSeverity::Harm:
      return dangerColour(palette);
    case operating::EventSeverity::Note:
      break;
  }
  return palette.color(QPalette::Text);
}

QColor colourOf(operating::Rating rating, const QPalette& palette) {
  if (rating == operating::Rating::Within) return goodColour(palette);
  return rating == operating::Rating::Outside ? warningColour(palette) : quietColour(palette);
}

QIcon symbolOf(operating::EventSeverity severity, const QPalette& palette) {
  const QColor colour = colourOf(severity, palette);
  switch (severity) {
    case operating::EventSeverity::Success:
      return drawn(colour, drawTick);
    case operating::EventSeverity::Warning:
      return drawn(colour, drawTriangle);
    case operating::EventSeverity::Bleeding:
      return drawn(colour, drawDrop);
    case operating::EventSeverity::Harm:
      return drawn(colour, drawCross);
    case operating::EventSeverity::Note:
      break;
  }
  return drawn(quietColour(palette), [](QPainter& painter) { painter.drawEllipse(10, 10, 12, 12); });
}

QIcon lamp(bool on, const QPalette& palette) {
  return drawn(on ? goodColour(palette) : quietColour(palette), [on](QPainter& painter) {
    if (on) painter.setBrush(painter.pen().color());
    painter.drawEllipse(6, 6, 20, 20);
  });
}

namespace {

constexpr double kSmaller = 0.9;

}  // namespace

QLabel* wrappingLabel(QWidget* parent) {
  auto* label = new QLabel(parent);
  label->setTextFormat(Qt::PlainText);
  label->setWordWrap(true);
  label->setTextInteractionFlags(Qt::TextSelectableByMouse);
  label->setMinimumWidth(1);
  return label;
}

void makeSmaller(QWidget& widget) {
  QFont font = widget.font();
  font.setPointSizeF(kSmaller * QFontInfo(font).pointSizeF());
  widget.setFont(font);
}

void TextRows::add(const QString& name, const QString& help) {
  auto* title = new QLabel(name);
  title->setToolTip(help);
  QLabel* value = wrappingLabel();
  value->setToolTip(help);
  value->setObjectName(name);
  const int row = layout_->rowCount();
  layout_->addWidget(title, row, 0, Qt::AlignLeft | Qt::AlignTop);
  layout_->addWidget(value, row, 1);
  layout_->setColumnStretch(1, 1);
  values_[name] = value;
}

void TextRows::set(const QString& name, const QString& value, const QString& help) {
  if (values_.count(name) == 0) add(name, help);
  QLabel* label = values_.at(name);
  label->setText(value);
  if (!help.isEmpty()) label->setToolTip(help);
}

void TextRows::mark(const QString& name, bool warns) {
  QLabel* label = values_.at(name);
  QFont font = label->font();
  if (font.bold() == warns) return;
  font.setBold(warns);
  label->setFont(font);
  QPalette palette = label->parentWidget() ? label->parentWidget()->palette() : QPalette();
  if (warns) palette.setColor(QPalette::WindowText, dangerColour(palette));
  label->setPalette(palette);
}

QLabel* TextRows::value(const QString& name) const {
  const auto found = values_.find(name);
  return found == values_.end() ? nullptr : found->second;
}

}  // namespace vibe::rviz_plugins
