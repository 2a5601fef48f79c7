#include "panels/event_list.hpp"

#include <cmath>

#include "messages/event_lines.hpp"
#include "messages/number_text.hpp"
#include "panels/panel_colours.hpp"
#include "panels/text_rows.hpp"

namespace vibe::rviz_plugins {
namespace {

constexpr int kLinesShown = 8;

std::string timeText(const vibe_msgs::ProcedureEvent& event, double origin) {
  const double time = event.header.stamp.toSec() - origin;
  return time >= 0 ? durationText(time) + "  " : std::string();
}

}  // namespace

EventList::EventList(QWidget* parent) : QListWidget(parent) {
  setWordWrap(true);
  setResizeMode(QListView::Adjust);
  setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
  setVerticalScrollMode(QAbstractItemView::ScrollPerPixel);
  setSelectionMode(QAbstractItemView::NoSelection);
  setFocusPolicy(Qt::NoFocus);
  setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Fixed);
  setIconSize({12, 12});
}

void EventList::add(const vibe_msgs::ProcedureEvent& event, double origin) {
  if (!isListed(event)) return;
  const EventSeverity severity = severityOf(event.kind);
  const std::string sentence = eventText(event);
  if (severity == EventSeverity::Note && sentence == newest_ && count() > 0)
    delete takeItem(0);  // it comes again and again
  newest_ = sentence;
  auto* entry = new QListWidgetItem(symbolOf(severity, palette()), toQt(timeText(event, origin) + sentence));
  entry->setForeground(colourOf(severity, palette()));
  entry->setToolTip(toQt(severityName(severity)));
  insertItem(0, entry);
  while (count() > kMax) delete takeItem(count() - 1);
}

QSize EventList::sizeHint() const {
  return {200, kLinesShown * fontMetrics().height() + 2 * frameWidth()};
}

}  // namespace vibe::rviz_plugins
