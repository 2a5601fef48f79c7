#include "panels/measures_view.hpp"

#include <QGridLayout>
#include <QLabel>
#include <limits>

#include "messages/number_text.hpp"
#include "messages/reference_values.hpp"
#include "panels/range_bar.hpp"
#include "panels/text_rows.hpp"

namespace vibe::rviz_plugins {

MeasuresView::MeasuresView(QWidget* parent) : QWidget(parent) {
  makeSmaller(*this);
  auto* grid = new QGridLayout(this);
  grid->setContentsMargins(0, 0, 0, 0);
  grid->setVerticalSpacing(2);
  grid->setHorizontalSpacing(6);
  grid->setColumnStretch(2, 1);
  for (const ShownMeasure& measure : measures()) {
    const int line = grid->rowCount();
    const QString help = toQt(explain(measure));
    auto* name = new QLabel(toQt(measure.label));
    Row row{new QLabel(kNoValue), nullptr};
    row.value->setObjectName(toQt(measure.label));
    row.value->setTextFormat(Qt::PlainText);
    grid->addWidget(name, line, 0);
    grid->addWidget(row.value, line, 1, Qt::AlignRight);
    if (!measure.source.empty()) {
      row.bar = new RangeBar;
      row.bar->setToolTip(help);
      grid->addWidget(row.bar, line, 2);
    }
    name->setToolTip(help);
    row.value->setToolTip(help);
    rows_.push_back(row);
  }
}

void MeasuresView::display(const PanelMessages& messages) {
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    const ShownMeasure& measure = measures()[i];
    double value = std::numeric_limits<double>::quiet_NaN();
    if (messages.state && messages.skill)
      value = measure.value({*messages.state, *messages.skill, messages.sutures.get()});
    rows_[i].value->setText(toQt(quantityText(value, measure.decimals, measure.unit)));
    if (!rows_[i].bar) continue;
    const Rating rating = rate(measure, value, messages.state && messages.state->phase == "done");
    rows_[i].bar->display(barShape(measure, value), rating);
    rows_[i].bar->setToolTip(toQt(explain(measure) + "\nNow: " + ratingText(rating) + "."));
  }
}

}  // namespace vibe::rviz_plugins
