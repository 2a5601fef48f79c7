#include <gtest/gtest.h>
#include <boost/make_shared.hpp>

#include <QLabel>
#include <QPushButton>
#include <QTableWidget>
#include <limits>

#include "offscreen.hpp"
#include "panels/control_boxes.hpp"
#include "panels/measures_view.hpp"
#include "panels/panel_style.hpp"
#include "panels/procedure_tables.hpp"
#include "panels/status_summary.hpp"
#include "vibe_operator/messages/reference_values.hpp"

namespace vibe::rviz_plugins::widgets_test {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

struct Widgets : testing::Test {
  Widgets() { offscreenApplication(); }

  static PanelMessages session() {
    auto state = boost::make_shared<vibe_msgs::ProcedureState>();
    state->scene = "stomach";
    state->time = 83;
    state->header.stamp.fromSec(84);
    state->tool_state = "contact";
    state->phase = "suture";
    state->bites = 9;
    state->sutures = 2;
    auto skill = boost::make_shared<vibe_msgs::SkillMetrics>();
    skill->area_reduction = kNaN;
    skill->mark_zones = 3;
    skill->burn_zones = skill->deep_burn_zones = 1;
    auto sutures = boost::make_shared<vibe_msgs::SutureArray>();
    sutures->sutures.resize(2);
    sutures->sutures[0].stage = vibe_msgs::Suture::CINCHED;
    sutures->sutures[0].bites.resize(7);
    sutures->sutures[1].bites.resize(2);
    return {state, skill, sutures, nullptr, nullptr, nullptr};
  }

  static geometry_msgs::WrenchStampedConstPtr force(double newton) {
    auto wrench = boost::make_shared<geometry_msgs::WrenchStamped>();
    wrench->wrench.force.y = newton;
    wrench->header.stamp.fromSec(84.4);
    return wrench;
  }
};

TEST_F(Widgets, aGlanceAnswersTheFourQuestions) {
  StatusSummary view;
  PanelMessages messages = session();
  messages.force = force(6.2);
  view.display(messages);
  EXPECT_EQ(textOf(view, "header"), "stomach, 1:23, running");
  EXPECT_EQ(textOf(view, "Bites"), "2 in set 2, 9 in all");
  EXPECT_TRUE(contains(textOf(view, "Bleeding"), "nothing bleeds"));
  EXPECT_TRUE(contains(textOf(view, "Pull"), "6.2 N: too hard"));
  EXPECT_TRUE(contains(textOf(view, "Tool"), "Touches tissue."));
  EXPECT_TRUE(contains(textOf(view, "Marks"), "3 zones"));
  EXPECT_TRUE(contains(textOf(view, "Burns"), "1 with the muscularis at risk"));
  EXPECT_TRUE(view.findChild<QLabel*>("Burns")->font().bold());
  messages.skill = nullptr;
  view.display(messages);
  EXPECT_EQ(textOf(view, "Burns"), "\u2013");
  EXPECT_FALSE(view.findChild<QLabel*>("Burns")->font().bold());
}

TEST_F(Widgets, aGentlePullIsGentle) {
  StatusSummary view;
  PanelMessages messages = session();
  messages.force = force(4.9);
  view.display(messages);
  EXPECT_TRUE(contains(textOf(view, "Pull"), "gentle"));
  messages.force = force(0);
  view.display(messages);
  EXPECT_EQ(textOf(view, "Pull"), "0.0 N, no contact");
  messages.force = force(kNaN);
  view.display(messages);
  EXPECT_EQ(textOf(view, "Pull"), "\u2013");
}

TEST_F(Widgets, bleedingIsBoldAndQuietAgain) {
  StatusSummary view;
  PanelMessages messages = session();
  auto bleeding = boost::make_shared<vibe_msgs::SutureArray>(*messages.sutures);
  bleeding->bleedings.resize(1);
  bleeding->bleedings[0].rate = 1e-7;
  bleeding->bleedings[0].brisk = true;
  messages.sutures = bleeding;
  view.display(messages);
  EXPECT_TRUE(contains(textOf(view, "Bleeding"), "1 brisk"));
  EXPECT_TRUE(view.findChild<QLabel*>("Bleeding")->font().bold());
  view.display(session());
  EXPECT_FALSE(view.findChild<QLabel*>("Bleeding")->font().bold());
}

TEST_F(Widgets, nothingKnownIsNoZero) {
  StatusSummary view;
  view.display({});
  EXPECT_EQ(textOf(view, "header"), "No session");
  for (const char* name : {"Bites", "Bleeding", "Pull", "Marks", "Burns", "Tool"})
    EXPECT_EQ(textOf(view, name), "\u2013") << name;
  MeasuresView measures_view;
  measures_view.display({});
  for (const operating::ShownMeasure& measure : operating::measures())
    EXPECT_EQ(textOf(measures_view, QString::fromStdString(measure.label)), "\u2013") << measure.label;
}

TEST_F(Widgets, scenesAreNoMarkup) {
  StatusSummary view;
  PanelMessages messages = session();
  auto state = boost::make_shared<vibe_msgs::ProcedureState>(*messages.state);
  state->scene = "<b>bold</b>";
  messages.state = state;
  view.display(messages);
  EXPECT_EQ(view.findChild<QLabel*>("header")->textFormat(), Qt::PlainText);
  EXPECT_TRUE(contains(textOf(view, "header"), "<b>bold</b>"));
}

TEST_F(Widgets, theStripShowsThePhase) {
  PhaseStrip strip;
  strip.resize(300, 24);
  strip.display(operating::phaseSteps("mark"));
  EXPECT_EQ(strip.accessibleName(), "Phase: mark");
  const QImage mark = pictureOf(strip);
  strip.display(operating::phaseSteps("pull"));
  EXPECT_NE(pictureOf(strip), mark);
  strip.display(operating::phaseSteps("mark"));
  EXPECT_EQ(pictureOf(strip), mark);
  EXPECT_LT(strip.minimumSizeHint().width(), 280) << "does not fit into a narrow dock";
}

TEST_F(Widgets, setsAreRows) {
  SutureTable table;
  table.display(operating::sutureRows(*session().sutures));
  ASSERT_EQ(table.rowCount(), 2);
  EXPECT_EQ(table.item(0, 1)->text(), "7");
  EXPECT_EQ(table.item(0, 5)->text(), "cinched");
  EXPECT_EQ(table.item(1, 5)->text(), "open");
  const int two = table.sizeHint().height();
  table.display(std::vector<operating::SutureRow>(5));
  EXPECT_GT(table.sizeHint().height(), two);
  const int five = table.sizeHint().height();
  table.display(std::vector<operating::SutureRow>(1000));
  EXPECT_LT(table.sizeHint().height(), 3 * five) << "many sets scroll";
  table.display({});
  EXPECT_EQ(table.rowCount(), 0);
}

TEST_F(Widgets, aSetShowsWhatWasPlannedAndWhatBothRulesSay) {
  auto sutures = *session().sutures;
  sutures.sutures[0].technique_name = "u";
  sutures.sutures[0].technique_margin = 0.99;
  sutures.sutures[0].printed_technique_name = "other";
  vibe_msgs::TraineeProgress progress;
  progress.goals.resize(1);
  progress.goals[0].pattern = "u";
  SutureTable table;
  table.resize(320, 120);
  table.display(operating::sutureRows(sutures, &progress));
  const std::vector<std::string> wanted = {"1", "7", "U", "U 99%", "other", "cinched"};
  for (std::size_t column = 0; column < wanted.size(); ++column)
    EXPECT_EQ(table.item(0, static_cast<int>(column))->text().toStdString(), wanted[column]);
  EXPECT_FALSE(table.item(0, 2)->font().bold());
  const QImage as_planned = pictureOf(table);
  progress.goals[0].pattern = "z";
  table.display(operating::sutureRows(sutures, &progress));
  EXPECT_TRUE(table.item(0, 2)->font().bold()) << "another technique than planned";
  EXPECT_NE(pictureOf(table), as_planned);
  // nothing is cut off in a dock of the usual width
  for (int column = 0; column < table.columnCount(); ++column) {
    const QTableWidgetItem& cell = *table.item(0, column);
    EXPECT_GE(table.columnWidth(column), QFontMetrics(cell.font()).horizontalAdvance(cell.text()) + 4)
        << table.horizontalHeaderItem(column)->text().toStdString();
  }
}

TEST_F(Widgets, measuresNameTheirSources) {
  MeasuresView view;
  view.display(session());
  EXPECT_EQ(textOf(view, "Sutures"), "2");
  EXPECT_EQ(textOf(view, "Bites per set"), "7.0");
  EXPECT_EQ(textOf(view, "Area reduction"), "\u2013");
  EXPECT_TRUE(view.findChild<QLabel*>("Area reduction")->toolTip().contains("Surg Endosc 2022"));
  EXPECT_TRUE(view.findChild<QLabel*>("Bite spacing")->toolTip().contains("No reference"));
}

TEST_F(Widgets, aBarTellsByShapeToo) {
  RangeBar bar;
  bar.resize(100, 16);
  const auto grey = [&bar](operating::Rating rating, double value) {
    bar.display(operating::barShape(operating::kPullingForce, value), rating);
    return pictureOf(bar).convertToFormat(QImage::Format_Alpha8);
  };
  const QImage within = grey(operating::Rating::Within, 4);
  EXPECT_NE(within, grey(operating::Rating::Outside, 4)) << "colour alone tells them apart";
  EXPECT_EQ(within, grey(operating::Rating::Within, 4));
  EXPECT_NE(within, grey(operating::Rating::Within, 2));
}

TEST_F(Widgets, symbolsDifferByShape) {
  const QPalette palette;
  std::vector<QImage> shapes;
  for (const operating::EventSeverity severity :
       {operating::EventSeverity::Note, operating::EventSeverity::Success, operating::EventSeverity::Warning,
        operating::EventSeverity::Bleeding, operating::EventSeverity::Harm})
    shapes.push_back(symbolOf(severity, palette).pixmap(32, 32).toImage().convertToFormat(QImage::Format_Alpha8));
  for (std::size_t i = 0; i < shapes.size(); ++i)
    for (std::size_t k = 0; k < i; ++k) EXPECT_NE(shapes[i], shapes[k]) << i << " and " << k;
}

TEST_F(Widgets, eventsComeNewestFirstAndAreBounded) {
  EventList list;
  vibe_msgs::ProcedureEvent event;
  event.kind = vibe_msgs::ProcedureEvent::REJECTED;
  event.header.stamp.fromSec(11);
  event.text = "first";
  list.add(event, 1);
  EXPECT_EQ(list.item(0)->text(), "10.0 s  Rejected: first");
  event.text = "second";
  list.add(event, 1);
  EXPECT_TRUE(list.item(0)->text().contains("second"));
  event.kind = vibe_msgs::ProcedureEvent::CONTACT_BEGIN;
  list.add(event, 1);
  EXPECT_EQ(list.count(), 2) << "contacts are not listed";
  event.kind = vibe_msgs::ProcedureEvent::MARK;
  for (int i = 0; i < 1000; ++i) {
    event.text = std::to_string(i);
    list.add(event, 1);
  }
  EXPECT_EQ(list.count(), EventList::kMax);
}

TEST_F(Widgets, aNoteThatComesAgainStandsThereOnceAWarningEachTime) {
  EventList list;
  vibe_msgs::ProcedureEvent note, warning;
  note.kind = vibe_msgs::ProcedureEvent::PRESSURE_REACHED;
  note.text = "reached";
  warning.kind = vibe_msgs::ProcedureEvent::WARNING;
  warning.text = "beware";
  for (int second = 1; second <= 3; ++second) {
    note.header.stamp.fromSec(second);
    list.add(note, 0);
  }
  ASSERT_EQ(list.count(), 1);
  EXPECT_EQ(list.item(0)->text(), "3.0 s  reached");
  list.add(warning, 0), list.add(warning, 0), list.add(note, 0);
  EXPECT_EQ(list.count(), 4);
}

TEST_F(Widgets, buttonsTellWhatWasPressed) {
  std::vector<int> pressed, released;
  std::vector<bool> control;
  CommandBox::Actions actions;
  actions.control = [&](bool on) { control.push_back(on); };
  actions.press = [&](int button) { pressed.push_back(button); };
  actions.release = [&](int button) { released.push_back(button); };
  CommandBox box(actions);
  auto* helix = box.findChild<QPushButton*>("Helix grab");
  helix->click();
  EXPECT_TRUE(pressed.empty()) << "without control";
  box.findChild<QPushButton*>("control")->click();
  EXPECT_EQ(control, std::vector<bool>{true});
  box.display(true, false, {}, "You have control.");
  for (const operating::Command& command : operating::commands())
    box.findChild<QPushButton*>(QString::fromStdString(command.label))->click();
  EXPECT_EQ(pressed, (std::vector<int>{0, 1, 2, 3, 4, 5}));
  EXPECT_EQ(released, pressed);
  EXPECT_EQ(control.size(), 1u) << "display() is not the user";
  EXPECT_TRUE(box.findChild<QPushButton*>("control")->isEnabled()) << "it can be given back";
  box.display(false, false, {}, "Another has control.");
  EXPECT_FALSE(box.findChild<QPushButton*>("control")->isEnabled());
}

TEST_F(Widgets, lampsFollowTheTopic) {
  CommandBox box({});
  const auto* button = box.findChild<QPushButton*>("Insufflate");
  const QImage off = button->icon().pixmap(32, 32).toImage();
  box.display(false, true, {0, 0, 0, 0, 0, 1}, "");
  EXPECT_NE(button->icon().pixmap(32, 32).toImage(), off);
  box.display(false, true, {}, "");
  EXPECT_EQ(button->icon().pixmap(32, 32).toImage(), off);
}

TEST_F(Widgets, steppingAsksTheRightThing) {
  std::vector<std::string> calls;
  SteppingBox::Actions actions;
  actions.pause = [&](bool paused) { calls.push_back(paused ? "pause" : "resume"); };
  actions.step = [&](unsigned n) { calls.push_back("step " + std::to_string(n)); };
  actions.reset = [&] { calls.push_back("reset"); };
  SteppingBox box(actions);
  const auto click = [&box](const QString& text) {
    for (auto* button : box.findChildren<QPushButton*>())
      if (button->text() == text) return button->click();
    FAIL() << "no button " << text.toStdString();
  };
  click("Pause");
  box.displayState(true, true);
  click("Resume");
  click("Step");
  click("Reset");
  EXPECT_EQ(calls, (std::vector<std::string>{"pause", "resume", "step 1"})) << "reset is asked twice";
  click("Sure?");
  EXPECT_EQ(calls.back(), "reset");
  box.displayWaiting("/pause", 0);
  click("Step");
  EXPECT_EQ(calls.size(), 4u) << "a call is under way";
  box.displayAnswer(false, "There is no service /pause.");
  EXPECT_EQ(textOf(box, "answer"), "Failed: There is no service /pause.");
}

TEST_F(Widgets, performanceHasDashesWithoutMessages) {
  SolverStatisticsView view;
  EXPECT_EQ(textOf(view, "Solver"), "\u2013");
  auto statistics = boost::make_shared<vibe_msgs::SolverStatistics>();
  statistics->real_time_factor = 0.98;
  PanelMessages messages = session();
  messages.solver_statistics = statistics;
  view.display(messages, {0.25, kNaN});
  EXPECT_EQ(textOf(view, "Real-time factor"), "0.98");
  EXPECT_EQ(textOf(view, "Last message"), "0.25 s ago");
  EXPECT_EQ(textOf(view, "Delay"), "\u2013");
}

}  // namespace
}  // namespace vibe::rviz_plugins::widgets_test
