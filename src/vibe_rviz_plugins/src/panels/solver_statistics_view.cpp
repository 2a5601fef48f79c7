#include "panels/solver_statistics_view.hpp"

#include <QGridLayout>
#include <QLabel>

#include "messages/number_text.hpp"
#include "messages/procedure_text.hpp"
#include "panels/text_rows.hpp"

namespace vibe::rviz_plugins {
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
  for (const NamedText& row :
       solverStatisticsRows(messages.solver_statistics ? *messages.solver_statistics : kNothing)) {
    rows_->set(toQt(row.name), messages.solver_statistics ? toQt(row.value) : kNoValue, toQt(row.help));
    rows_->mark(toQt(row.name), messages.solver_statistics && row.warns);
  }
  const bool known = static_cast<bool>(messages.state);
  rows_->set("Last message", known ? toQt(quantityText(freshness.age, 2, "s") + " ago") : kNoValue, kAgeHelp);
  rows_->set("Delay", known ? toQt(quantityText(1e3 * freshness.delay, 0, "ms")) : kNoValue, kDelayHelp);
}

}  // namespace vibe::rviz_plugins
