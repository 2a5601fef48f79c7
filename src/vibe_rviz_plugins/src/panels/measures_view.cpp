#include "panels/measures_view.hpp"

#include <QGridLayout>
#include <QLabel>
#include <QPainter>
#include <limits>

#include "panels/panel_style.hpp"
#include "vibe_operator/messages/number_text.hpp"
#include "vibe_operator/messages/procedure_text.hpp"
#include "vibe_operator/messages/reference_values.hpp"

namespace vibe::rviz_plugins {

namespace {

constexpr double kMark = 5;   // radius of the mark [px]
constexpr double kTrack = 3;  // half of the height of the band [px]

}  // namespace

RangeBar::RangeBar(QWidget* parent) : QWidget(parent) {
  setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Fixed);
}

void RangeBar::display(const operating::BarShape& shape, operating::Rating rating) {
  shape_ = shape;
  rating_ = rating;
  setAccessibleName(QString::fromStdString(operating::ratingText(rating)));
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
  painter.setBrush(rating_ == operating::Rating::Within || rating_ == operating::Rating::Outside
                       ? QBrush(colour)
                       : palette().brush(QPalette::Window));
  if (shape_.beyond) {
    const double tip = shape_.value > 0.5 ? kMark : -kMark;
    painter.drawPolygon(QVector<QPointF>{{x - tip, y - kMark}, {x + tip, y}, {x - tip, y + kMark}});
  } else if (rating_ == operating::Rating::Outside) {
    painter.drawPolygon(QVector<QPointF>{{x, y - kMark}, {x + kMark, y + kMark}, {x - kMark, y + kMark}});
  } else {
    painter.drawEllipse(QPointF(x, y), kMark - 1, kMark - 1);
  }
}

MeasuresView::MeasuresView(QWidget* parent) : QWidget(parent) {
  makeSmaller(*this);
  auto* grid = new QGridLayout(this);
  grid->setContentsMargins(0, 0, 0, 0);
  grid->setVerticalSpacing(2);
  grid->setHorizontalSpacing(6);
  grid->setColumnStretch(2, 1);
  for (const operating::ShownMeasure& measure : operating::measures()) {
    const int line = grid->rowCount();
    const QString help = toQt(operating::explain(measure));
    auto* name = new QLabel(toQt(measure.label));
    Row row{new QLabel(operating::kNoValue), nullptr};
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
    const operating::ShownMeasure& measure = operating::measures()[i];
    double value = std::numeric_limits<double>::quiet_NaN();
    if (messages.state && messages.skill)
      value = measure.value({*messages.state, *messages.skill, messages.sutures.get()});
    rows_[i].value->setText(toQt(operating::quantityText(value, measure.decimals, measure.unit)));
    if (!rows_[i].bar) continue;
    const operating::Rating rating = operating::rate(measure, value, messages.state && messages.state->phase == "done");
    rows_[i].bar->display(operating::barShape(measure, value), rating);
    rows_[i].bar->setToolTip(toQt(operating::explain(measure) + "\nNow: " + operating::ratingText(rating) + "."));
  }
}

namespace {

const char* const kAgeHelp = "Wall time since the last message about the tool or, without a tool, about the state.";
const char* const kDelayHelp =
    "Time from the sample to its arrival here, maximum of the last second. Surgeons did worse with 105 ms of added "
    "delay "
    "(Kumcu et al. 2016). "
    "Not known with simulated time, because stamps are not wall time then.";

}  // namespace

SolverStatisticsView::SolverStatisticsView(QWidget* parent) : QWidget(parent) {
  makeSmaller(*this);
  auto* grid = new QGridLayout(this);
  grid->setContentsMargins(0, 0, 0, 0);
  grid->setVerticalSpacing(2);
  rows_ = std::make_unique<TextRows>(grid);
  display({}, {});
}

SolverStatisticsView::~SolverStatisticsView() = default;

void SolverStatisticsView::display(const PanelMessages& messages, const Freshness& freshness) {
  static const vibe_msgs::SolverStatistics kNothing;
  for (const operating::NamedText& row :
       operating::solverStatisticsRows(messages.solver_statistics ? *messages.solver_statistics : kNothing)) {
    rows_->set(toQt(row.name), messages.solver_statistics ? toQt(row.value) : operating::kNoValue, toQt(row.help));
    rows_->mark(toQt(row.name), messages.solver_statistics && row.warns);
  }
  const bool known = static_cast<bool>(messages.state);
  rows_->set("Last message",
             known ? toQt(operating::quantityText(freshness.age, 2, "s") + " ago") : operating::kNoValue, kAgeHelp);
  rows_->set("Delay", known ? toQt(operating::quantityText(1e3 * freshness.delay, 0, "ms")) : operating::kNoValue,
             kDelayHelp);
}

}  // namespace vibe::rviz_plugins
