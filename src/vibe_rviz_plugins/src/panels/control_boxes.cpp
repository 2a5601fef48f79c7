#include "panels/control_boxes.hpp"

#include <QGridLayout>
#include <QLabel>
#include <QPushButton>
#include <QSpinBox>
#include <QTimer>

#include "panels/panel_style.hpp"
#include "vibe_operator/messages/number_text.hpp"

namespace vibe::rviz_plugins {

namespace {

constexpr int kButtonColumns = 2;

}  // namespace

CommandBox::CommandBox(Actions actions, QWidget* parent)
    : QWidget(parent),
      actions_(std::move(actions)),
      control_(new QPushButton("Take control")),
      sentence_(wrappingLabel()) {
  control_->setObjectName("control");
  control_->setCheckable(true);
  control_->setIcon(lamp(false, palette()));
  control_->setToolTip(
      "Publishes the buttons below while it is on. The simulator obeys one publisher at a time: stop the scripted "
      "trainee or the device first.");
  sentence_->setObjectName("control sentence");
  auto* grid = new QGridLayout(this);
  grid->setContentsMargins(0, 0, 0, 0);
  grid->addWidget(control_, 0, 0, 1, kButtonColumns);
  for (int button = 0; button < operating::kCommandCount; ++button) {
    makeButton(button);
    grid->addWidget(buttons_[static_cast<std::size_t>(button)], 1 + button / kButtonColumns, button % kButtonColumns);
  }
  // below the buttons and at least two lines high, so that a changing sentence does not move the buttons
  sentence_->setMinimumHeight(2 * sentence_->fontMetrics().lineSpacing());
  sentence_->setAlignment(Qt::AlignTop);
  grid->addWidget(sentence_, 1 + (operating::kCommandCount + kButtonColumns - 1) / kButtonColumns, 0, 1,
                  kButtonColumns);
  // clicked, not toggled: reacts to the user only, not to display()
  QObject::connect(control_, &QPushButton::clicked, this, [this](bool on) { actions_.control(on); });
}

void CommandBox::makeButton(int button) {
  const operating::Command& command = operating::commands()[static_cast<std::size_t>(button)];
  auto* widget = new QPushButton(lamp(false, palette()), toQt(command.label));
  widget->setObjectName(toQt(command.label));
  widget->setToolTip(toQt(command.help));
  widget->setEnabled(false);
  QObject::connect(widget, &QPushButton::pressed, this, [this, button] { actions_.press(button); });
  QObject::connect(widget, &QPushButton::released, this, [this, button] { actions_.release(button); });
  buttons_[static_cast<std::size_t>(button)] = widget;
}

void CommandBox::display(bool in_control, bool may_take, const std::array<std::int32_t, operating::kCommandCount>& down,
                         const std::string& sentence) {
  control_->setEnabled(in_control || may_take);
  control_->setChecked(in_control);
  control_->setText(in_control ? "Give control back" : "Take control");
  if (in_control != shown_control_) control_->setIcon(lamp(in_control, palette()));
  shown_control_ = in_control;
  sentence_->setText(toQt(sentence));
  for (std::size_t i = 0; i < buttons_.size(); ++i) {
    buttons_[i]->setEnabled(in_control);
    if (down[i] == shown_[i]) continue;
    shown_[i] = down[i];
    buttons_[i]->setIcon(lamp(down[i] != 0, palette()));
  }
}

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
  answer_->setText(
      toQt("Waiting for " + service +
           (seconds > kSlowCall ? ": no answer for " + operating::quantityText(seconds, 0, "s") + "." : ".")));
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
