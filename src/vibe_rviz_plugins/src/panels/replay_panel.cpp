#include "panels/replay_panel.hpp"

#include <vibe_msgs/ReplayCommand.h>

#include <QComboBox>
#include <QFileInfo>
#include <QGridLayout>
#include <QLabel>
#include <QPushButton>
#include <cmath>
#include <limits>
#include <pluginlib/class_list_macros.hpp>

#include "panels/replay_slider.hpp"
#include "panels/text_rows.hpp"

namespace vibe::rviz_plugins {
namespace {

constexpr double kStay = std::numeric_limits<double>::quiet_NaN();
const char kPhase[] = "phase";

QString minutes(double seconds) {
  const int whole = static_cast<int>(seconds);
  return QString("%1:%2").arg(whole / 60).arg(seconds - 60 * (whole / 60), 4, 'f', 1, '0');
}

std::vector<ReplaySlider::Mark> marksOf(const vibe_msgs::ReplayStatus& status) {
  std::vector<ReplaySlider::Mark> marks;
  for (std::size_t k = 0; k < std::min(status.marks.size(), status.mark_times.size()); ++k) {
    const QString text = QString::fromStdString(status.marks[k]);
    marks.push_back({status.mark_times[k], text.startsWith(kPhase) ? text.mid(6) : text, text.startsWith(kPhase)});
  }
  return marks;
}

// What is known of the comparison, as the rest of a sentence.
QString comparison(const vibe_msgs::ReplayStatus& status) {
  const QString why = QString::fromStdString(status.difference);
  if (!status.same) return ": NOT the same: " + why;
  if (status.checked) return ": the same as recorded so far";
  return why.isEmpty() ? QString() : ": not checked: " + why;
}

}  // namespace

ReplayPanel::ReplayPanel(QWidget* parent)
    : rviz::Panel(parent),
      slider_(new ReplaySlider([this](double time, bool exact) { command(status_.playing, time, exact); })),
      play_(new QPushButton("Play")),
      rate_(new QComboBox),
      time_(new QLabel("no recording")),
      state_(wrappingLabel()) {
  auto* grid = new QGridLayout(this);
  grid->addWidget(play_, 0, 0);
  grid->addWidget(rate_, 0, 1);
  grid->addWidget(time_, 0, 2);
  grid->addWidget(slider_, 1, 0, 1, 3);
  grid->addWidget(state_, 2, 0, 1, 3);
  grid->setColumnStretch(2, 1);
  grid->setRowStretch(3, 1);
  play_->setObjectName("play");
  time_->setObjectName("time");
  state_->setObjectName("state");
  rate_->setToolTip("Speed, compared with the session.");
  for (const double rate : {0.1, 0.25, 0.5, 1.0, 2.0, 4.0}) rate_->addItem(QString("x %1").arg(rate), rate);
  rate_->setCurrentIndex(3);
  setEnabled(false);
  QObject::connect(play_, &QPushButton::clicked, this, [this] { command(!status_.playing, kStay, true); });
  QObject::connect(rate_, QOverload<int>::of(&QComboBox::activated), this,
                   [this] { command(status_.playing, kStay, true); });
}

void ReplayPanel::onInitialize() {
  ros::NodeHandle handle;
  commands_ = handle.advertise<vibe_msgs::ReplayCommand>("replay/command", 10);
  statuses_ = handle.subscribe("replay/status", 10, &ReplayPanel::display, this);
}

double ReplayPanel::rate() const {
  return rate_->currentData().toDouble();
}

void ReplayPanel::command(bool play, double seek, bool exact) {
  vibe_msgs::ReplayCommand message;
  message.play = play;
  message.rate = rate();
  message.seek = seek;
  message.exact = exact;
  commands_.publish(message);
}

void ReplayPanel::display(const vibe_msgs::ReplayStatus& status) {
  status_ = status;
  setEnabled(true);
  play_->setText(status.playing ? "Pause" : "Play");
  time_->setText(minutes(status.time) + " of " + minutes(status.duration));
  slider_->display(status.time, status.duration, marksOf(status));
  const QString name = QFileInfo(QString::fromStdString(status.file)).fileName();
  state_->setText(name + comparison(status));
}

}  // namespace vibe::rviz_plugins

PLUGINLIB_EXPORT_CLASS(vibe::rviz_plugins::ReplayPanel, rviz::Panel)
