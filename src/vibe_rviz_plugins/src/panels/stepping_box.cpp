#include "panels/stepping_box.hpp"

#include <QGridLayout>
#include <QLabel>
#include <QPushButton>
#include <QSpinBox>
#include <QTimer>

#include "messages/number_text.hpp"
#include "panels/panel_colours.hpp"
#include "panels/text_rows.hpp"

namespace vibe::rviz_plugins {
namespace {

constexpr int kMaxSteps = 10000;
constexpr int kResetTimeout = 3000;  // to press reset a second time [ms]
constexpr double kSlowCall = 1;      // a call that takes longer is reported and can be abandoned [s]

}  // namespace

SteppingBox::SteppingBox(Actions actions, QWidget* parent)
    : QWidget(parent),
      actions_(std::move(actions)),
      pause_(new QPushButton("Pause")),
      step_(new QPushButton("Step")),
      reset_(new QPushButton("Reset")),
      stop_waiting_(new QPushButton("Stop waiting")),
      count_(new QSpinBox),
      answer_(wrappingLabel()) {
  auto* grid = new QGridLayout(this);
  grid->setContentsMargins(0, 0, 0, 0);
  grid->addWidget(pause_, 0, 0);
  grid->addWidget(reset_, 0, 1);
  grid->addWidget(step_, 1, 0);
  grid->addWidget(count_, 1, 1);
  grid->addWidget(answer_, 2, 0, 1, 2);
  grid->addWidget(stop_waiting_, 3, 0, 1, 2);
  pause_->setToolTip("Pauses or resumes the simulation.");
  step_->setToolTip("Takes this many steps while the simulation is paused.");
  reset_->setToolTip("Returns to the initial state with the seed of the scene; press twice. Stamps continue.");
  stop_waiting_->setToolTip("Abandons the call; the simulator may still carry it out.");
  count_->setToolTip("Steps to take at once.");
  count_->setRange(1, kMaxSteps);
  count_->setPrefix("steps: ");
  answer_->setObjectName("answer");
  stop_waiting_->hide();
  connectAll();
}

void SteppingBox::connectAll() {
  QObject::connect(pause_, &QPushButton::clicked, this, [this] { actions_.pause(!paused_); });
  QObject::connect(step_, &QPushButton::clicked, this,
                   [this] { actions_.step(static_cast<unsigned>(count_->value())); });
  QObject::connect(reset_, &QPushButton::clicked, this, [this] { pressReset(); });
  QObject::connect(stop_waiting_, &QPushButton::clicked, this, [this] { actions_.stop_waiting(); });
}

// a reset cannot be undone, and a dialog would block rviz
void SteppingBox::pressReset() {
  if (asked_) {
    asked_ = false;
    reset_->setText("Reset");
    actions_.reset();
    return;
  }
  asked_ = true;
  reset_->setText("Sure?");
  QTimer::singleShot(kResetTimeout, this, [this] {
    asked_ = false;
    reset_->setText("Reset");
  });
}

void SteppingBox::displayState(bool known, bool paused) {
  paused_ = known && paused;
  pause_->setText(paused_ ? "Resume" : "Pause");
}

void SteppingBox::displayWaiting(const std::string& service, double seconds) {
  waiting_ = true;
  enableAll();
  stop_waiting_->setVisible(seconds > kSlowCall);
  answer_->setPalette(palette());
  answer_->setText(toQt("Waiting for " + service +
                        (seconds > kSlowCall ? ": no answer for " + quantityText(seconds, 0, "s") + "." : ".")));
}

void SteppingBox::displayAnswer(bool success, const std::string& sentence) {
  waiting_ = false;
  enableAll();
  stop_waiting_->hide();
  QPalette colours = palette();
  if (!success) colours.setColor(QPalette::WindowText, dangerColour(colours));
  answer_->setPalette(colours);
  answer_->setText(toQt(success ? sentence : "Failed: " + sentence));
}

void SteppingBox::enableAll() {
  for (QWidget* widget : {static_cast<QWidget*>(pause_), static_cast<QWidget*>(step_), static_cast<QWidget*>(reset_)})
    widget->setEnabled(!waiting_);
}

}  // namespace vibe::rviz_plugins
