#include "panels/text_rows.hpp"

#include <QFontInfo>
#include <QGridLayout>
#include <QLabel>

#include "panels/panel_colours.hpp"

namespace vibe::rviz_plugins {
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
