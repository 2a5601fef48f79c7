#include "panels/procedure_tables.hpp"

#include <QHeaderView>
#include <array>
#include <cmath>

#include "panels/panel_style.hpp"
#include "vibe_operator/messages/number_text.hpp"
#include "vibe_operator/messages/table_rows.hpp"

namespace vibe::rviz_plugins {

namespace {

constexpr int kLinesShown = 8;

std::string timeText(const vibe_msgs::ProcedureEvent& event, double origin) {
  const double time = event.header.stamp.toSec() - origin;
  return time >= 0 ? operating::durationText(time) + "  " : std::string();
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
  if (!operating::isListed(event)) return;
  const operating::EventSeverity severity = operating::severityOf(event.kind);
  const std::string sentence = operating::eventText(event);
  if (severity == operating::EventSeverity::Note && sentence == newest_ && count() > 0)
    delete takeItem(0);  // it comes again and again
  newest_ = sentence;
  auto* entry = new QListWidgetItem(symbolOf(severity, palette()), toQt(timeText(event, origin) + sentence));
  entry->setForeground(colourOf(severity, palette()));
  entry->setToolTip(toQt(operating::severityName(severity)));
  insertItem(0, entry);
  while (count() > kMax) delete takeItem(count() - 1);
}

QSize EventList::sizeHint() const {
  return {200, kLinesShown * fontMetrics().height() + 2 * frameWidth()};
}

namespace {

constexpr int kMaxShown = 8;  // rows without scrolling

constexpr int kTechnique = 3;  // column

struct Column {
  const char* title;
  const char* help;
};
constexpr std::array<Column, 7> kTableColumns = {{
    {"#", "Number of the set, in the order of first bites."},
    {"Bites", "Bites that hold; torn-out bites in brackets."},
    {"Plan", "Technique that the goal of a trainee asks for (trainee/progress)."},
    {"Found", "Technique recognised when the T-tag is dropped, by the rule of the scene, and its margin."},
    {"Paper", "The same by the rule as printed in the ViBE paper, which knows U, Z and other."},
    {"Stage",
     "Open: takes bites. Tagged: the T-tag is dropped. Cinched: permanent. Loose: cinched with too little tension."},
    {"N", "Maximum tension of the thread now [N]."},
}};

}  // namespace

SutureTable::SutureTable(QWidget* parent) : QTableWidget(0, static_cast<int>(kTableColumns.size()), parent) {
  for (std::size_t column = 0; column < kTableColumns.size(); ++column) {
    auto* title = new QTableWidgetItem(kTableColumns[column].title);
    title->setToolTip(kTableColumns[column].help);
    setHorizontalHeaderItem(static_cast<int>(column), title);
  }
  makeSmaller(*this);
  horizontalHeader()->setFont(font());
  setSelectionMode(QAbstractItemView::NoSelection);
  setFocusPolicy(Qt::NoFocus);
  setEditTriggers(QAbstractItemView::NoEditTriggers);
  setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
  setWordWrap(false);
  verticalHeader()->hide();
  verticalHeader()->setSectionResizeMode(QHeaderView::Fixed);
  verticalHeader()->setMinimumSectionSize(1);
  verticalHeader()->setDefaultSectionSize(fontMetrics().height() + 6);
  horizontalHeader()->setMinimumSectionSize(1);
  horizontalHeader()->setSectionResizeMode(QHeaderView::ResizeToContents);
  // the longest name of a technique may not fit; the tool tip shows it
  horizontalHeader()->setSectionResizeMode(kTechnique, QHeaderView::Stretch);
  setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Fixed);
}

void SutureTable::display(const std::vector<operating::SutureRow>& rows) {
  const int count = static_cast<int>(rows.size());
  const bool changed = count != rowCount();
  if (changed) setRowCount(count);
  for (int row = 0; row < count; ++row) displayRow(row, rows[static_cast<std::size_t>(row)]);
  if (!changed) return;
  updateGeometry();
  scrollToBottom();
}

void SutureTable::displayRow(int row, const operating::SutureRow& content) {
  const std::array<std::string, 7> texts = {content.set,     content.bites, content.planned, content.technique,
                                            content.printed, content.stage, content.tension};
  for (int column = 0; column < columnCount(); ++column) {
    QTableWidgetItem* cell = item(row, column);
    if (!cell) {
      cell = new QTableWidgetItem;
      setItem(row, column, cell);
    }
    const QString text = toQt(texts[static_cast<std::size_t>(column)]);
    if (cell->text() != text) cell->setText(text);
    const QString help = toQt(content.help);
    if (cell->toolTip() != help) cell->setToolTip(help);
    QFont face = font();
    face.setBold(content.warns);
    if (cell->font() != face) cell->setFont(face);
    const QBrush brush(content.warns ? dangerColour(palette()) : palette().color(QPalette::Text));
    if (cell->foreground() != brush) cell->setForeground(brush);
  }
}

QSize SutureTable::sizeHint() const {
  const int shown = std::max(1, std::min(rowCount(), kMaxShown));
  return {200,
          horizontalHeader()->sizeHint().height() + shown * verticalHeader()->defaultSectionSize() + 2 * frameWidth()};
}

}  // namespace vibe::rviz_plugins
