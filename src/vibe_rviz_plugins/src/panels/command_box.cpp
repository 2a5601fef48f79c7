#include "panels/command_box.hpp"

#include <QGridLayout>
#include <QLabel>
#include <QPushButton>

#include "panels/panel_colours.hpp"
#include "panels/text_rows.hpp"

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
  for (int button = 0; button < kCommandCount; ++button) {
    makeButton(button);
    grid->addWidget(buttons_[static_cast<std::size_t>(button)], 1 + button / kButtonColumns, button % kButtonColumns);
  }
  // below the buttons and at least two lines high, so that a changing sentence does not move the buttons
  sentence_->setMinimumHeight(2 * sentence_->fontMetrics().lineSpacing());
  sentence_->setAlignment(Qt::AlignTop);
  grid->addWidget(sentence_, 1 + (kCommandCount + kButtonColumns - 1) / kButtonColumns, 0, 1, kButtonColumns);
  // clicked, not toggled: reacts to the user only, not to display()
  QObject::connect(control_, &QPushButton::clicked, this, [this](bool on) { actions_.control(on); });
}

void CommandBox::makeButton(int button) {
  const Command& command = commands()[static_cast<std::size_t>(button)];
  auto* widget = new QPushButton(lamp(false, palette()), toQt(command.label));
  widget->setObjectName(toQt(command.label));
  widget->setToolTip(toQt(command.help));
  widget->setEnabled(false);
  QObject::connect(widget, &QPushButton::pressed, this, [this, button] { actions_.press(button); });
  QObject::connect(widget, &QPushButton::released, this, [this, button] { actions_.release(button); });
  buttons_[static_cast<std::size_t>(button)] = widget;
}

void CommandBox::display(bool in_control, const std::array<std::int32_t, kCommandCount>& down,
                         const std::string& sentence) {
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

}  // namespace vibe::rviz_plugins
