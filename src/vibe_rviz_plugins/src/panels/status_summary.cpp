#include "panels/status_summary.hpp"

#include <QFont>
#include <QFontInfo>
#include <QFontMetrics>
#include <QGridLayout>
#include <QLabel>
#include <QPainter>
#include <QVBoxLayout>
#include <algorithm>
#include <cmath>
#include <limits>

#include "panels/measures_view.hpp"
#include "panels/panel_style.hpp"
#include "vibe_operator/messages/number_text.hpp"
#include "vibe_operator/messages/procedure_text.hpp"
#include "vibe_operator/messages/reference_values.hpp"

namespace vibe::rviz_plugins {

namespace {

constexpr double kGap = 3;          // between two steps [px]
constexpr double kRound = 4;        // radius of corners [px]
constexpr double kSmallest = 0.75;  // of the font, where the dock is narrow
constexpr int kStepMargin = 10;     // of a step's height besides its text [px]
constexpr int kSideMargin = 4;      // left and right of a step's text [px]

QFont bold(QFont font) {
  font.setBold(true);
  return font;
}

double widthOf(const operating::PhaseStep& step, const QFont& face) {
  return QFontMetrics(bold(face)).horizontalAdvance(QString::fromStdString(step.name)) + 2 * kSideMargin;
}

}  // namespace

PhaseStrip::PhaseStrip(QWidget* parent) : QWidget(parent), steps_(operating::phaseSteps("")) {
  setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Fixed);
  setToolTip("Phase of the procedure; it follows from what is done.");
}

void PhaseStrip::display(const std::array<operating::PhaseStep, operating::kPhaseCount>& steps) {
  steps_ = steps;
  QString present = "Phase unknown";
  for (const operating::PhaseStep& step : steps_)
    if (step.kind == operating::StepKind::Present) present = "Phase: " + QString::fromStdString(step.name);
  setAccessibleName(present);
  update();
}

double PhaseStrip::minWidth(const QFont& face) const {
  double width = kGap * (operating::kPhaseCount - 1);
  for (const operating::PhaseStep& step : steps_) width += widthOf(step, face);
  return width;
}

QSize PhaseStrip::sizeHint() const {
  return {static_cast<int>(minWidth(font())) + 1, QFontMetrics(bold(font())).height() + kStepMargin};
}

QSize PhaseStrip::minimumSizeHint() const {
  return {static_cast<int>(kSmallest * minWidth(font())) + 1, sizeHint().height()};
}

QFont PhaseStrip::fittingFont() const {
  QFont face = font();
  const double share = std::max(kSmallest, std::min(1.0, width() / minWidth(face)));
  face.setPointSizeF(share * QFontInfo(face).pointSizeF());
  return face;
}

void PhaseStrip::paintEvent(QPaintEvent*) {
  QPainter painter(this);
  painter.setRenderHint(QPainter::Antialiasing);
  const QFont face = fittingFont();
  const double extra = (width() - minWidth(face)) / operating::kPhaseCount;
  double left = 0;
  for (const operating::PhaseStep& step : steps_) {
    const double width = widthOf(step, face) + extra;
    painter.setFont(step.kind == operating::StepKind::Present ? bold(face) : face);
    paintStep(painter, QRectF(left + 1, 1, width - 2, height() - 2), step);
    left += width + kGap;
  }
}

void PhaseStrip::paintStep(QPainter& painter, const QRectF& place, const operating::PhaseStep& step) const {
  const bool present = step.kind == operating::StepKind::Present;
  const QColor quiet = quietColour(palette());
  painter.setPen(QPen(present ? palette().color(QPalette::Text) : quiet, present ? 2 : 1));
  painter.setBrush(present ? palette().brush(QPalette::Highlight) : QBrush(Qt::NoBrush));
  painter.drawRoundedRect(place, kRound, kRound);
  if (step.kind == operating::StepKind::Before) {
    // a line below what is behind
    painter.setPen(QPen(goodColour(palette()), 3));
    painter.drawLine(place.bottomLeft() + QPointF(kRound, -2), place.bottomRight() + QPointF(-kRound, -2));
  }
  painter.setPen(palette().color(present ? QPalette::HighlightedText : QPalette::WindowText));
  painter.drawText(place, Qt::AlignCenter, QString::fromStdString(step.name));
}

namespace {

constexpr double kStatePeriod = 1;  // between two messages of the state at most, in simulated time [s]

/// The state comes once a second; the force, which comes with every step, says how much later it is by now.
double timeNow(const PanelMessages& messages) {
  double later = 0;
  if (messages.force) later = (messages.force->header.stamp - messages.state->header.stamp).toSec();
  return messages.state->time + std::max(0.0, std::min(later, kStatePeriod));
}

double forceNow(const geometry_msgs::WrenchStamped& wrench) {
  const auto& f = wrench.wrench.force;
  return std::sqrt(f.x * f.x + f.y * f.y + f.z * f.z);
}

QString forceText(double force) {
  const QString number = toQt(operating::quantityText(force, 1, "N"));
  if (!std::isfinite(force)) return number;
  if (force == 0) return number + ", no contact";
  return number + (force > operating::kPullingForce.high ? ": too hard, seldom above 5 N" : ", gentle enough");
}

}  // namespace

StatusSummary::StatusSummary(QWidget* parent)
    : QWidget(parent), header_(wrappingLabel()), phases_(new PhaseStrip), force_bar_(new RangeBar) {
  auto* column = new QVBoxLayout(this);
  column->setContentsMargins(0, 0, 0, 0);
  header_->setObjectName("header");
  header_->setToolTip("Scene, simulated time since the start of the state, and whether steps are taken.");
  QFont font = header_->font();
  font.setBold(true);
  header_->setFont(font);
  column->addWidget(header_);
  column->addWidget(phases_);
  auto* grid = new QGridLayout;
  column->addLayout(grid);
  rows_ = std::make_unique<TextRows>(grid);
  rows_->add("Tool", "What the tool does to the organ at the moment, and where the needle is.");
  rows_->add("Bites", "In the set at work, and in all sets.");
  rows_->add("Bleeding", "Bites that bleed now, and the blood lost so far. Completing a set stops what bleeds in it.");
  rows_->add("Pull", toQt(operating::explain(operating::kPullingForce)));
  force_bar_->setToolTip(toQt(operating::explain(operating::kPullingForce)));
  grid->addWidget(force_bar_, grid->rowCount(), 1);
  rows_->add("Marks", "Marks that hang together are one zone; by wall.");
  rows_->add("Burns", "Zones with a burn scar or worse, and those where the muscularis is at risk.");
}

StatusSummary::~StatusSummary() = default;

void StatusSummary::display(const PanelMessages& messages) {
  displayState(messages);
  displaySkill(messages);
  displayBleeding(messages);
  displayForce(messages);
}

void StatusSummary::displayState(const PanelMessages& messages) {
  if (!messages.state) {
    header_->setText("No session");
    phases_->display(operating::phaseSteps(""));
    for (const char* name : {"Tool", "Bites"}) rows_->set(name, operating::kNoValue);
    return;
  }
  const vibe_msgs::ProcedureState& state = *messages.state;
  header_->setText(toQt(state.scene + ", " + operating::durationText(timeNow(messages)) +
                        (state.paused ? ", PAUSED" : ", running")));
  phases_->display(operating::phaseSteps(state.phase));
  rows_->set("Tool", toQt(operating::toolText(state)));
  rows_->set("Bites", toQt(operating::bitesText(state, messages.sutures.get())));
  rows_->mark("Bites", state.tear_outs > 0);
}

void StatusSummary::displaySkill(const PanelMessages& messages) {
  const vibe_msgs::SkillMetrics* skill = messages.skill.get();
  rows_->set("Marks", skill ? toQt(operating::marksText(*skill)) : QString(operating::kNoValue));
  rows_->set("Burns", skill ? toQt(operating::burnsText(*skill)) : QString(operating::kNoValue));
  rows_->mark("Burns", skill && skill->deep_burn_zones > 0);
}

void StatusSummary::displayBleeding(const PanelMessages& messages) {
  if (!messages.sutures) {
    rows_->set("Bleeding", operating::kNoValue);
    rows_->mark("Bleeding", false);
    return;
  }
  const operating::BleedingSummary bleeding = operating::summariseBleeding(*messages.sutures);
  const std::string lost = " (" + operating::quantityText(1e6 * bleeding.lost, 1, "mL") + " lost)";
  rows_->set("Bleeding", toQt(operating::bleedingText(bleeding) + (bleeding.lost > 0 ? lost : std::string())));
  rows_->mark("Bleeding", bleeding.brisk + bleeding.mild > 0);
}

void StatusSummary::displayForce(const PanelMessages& messages) {
  const double force = messages.force ? forceNow(*messages.force) : std::numeric_limits<double>::quiet_NaN();
  const operating::Rating rating = operating::rate(operating::kPullingForce, force, false);
  rows_->set("Pull", forceText(force));
  rows_->mark("Pull", rating == operating::Rating::Outside);
  force_bar_->display(operating::barShape(operating::kPullingForce, force), rating);
}

}  // namespace vibe::rviz_plugins
