#include "panels/replay_panel.hpp"

#include <QComboBox>
#include <QFileInfo>
#include <QGridLayout>
#include <QHelpEvent>
#include <QLabel>
#include <QMouseEvent>
#include <QPainter>
#include <QPushButton>
#include <QToolTip>
#include <algorithm>
#include <cmath>
#include <limits>

#include <vibe_msgs/ReplayCommand.h>
#include <pluginlib/class_list_macros.hpp>

#include "panels/panel_style.hpp"

namespace vibe::rviz_plugins {

namespace {

constexpr int kHandleMargin = 8;     // at both ends, for the handle [px]
constexpr int kTop = 22, kBar = 10;  // below the names of the phases; height of the bar [px]
constexpr int kNear = 4;             // of a mark, for its text [px]

}  // namespace

ReplaySlider::ReplaySlider(Seek seek, QWidget* parent) : QWidget(parent), seek_(std::move(seek)) {
  setObjectName("slider");
  setCursor(Qt::PointingHandCursor);
}

void ReplaySlider::display(double time, double duration, std::vector<Mark> marks) {
  duration_ = duration;
  if (!dragged_) time_ = time;
  marks_ = std::move(marks);
  update();
}

double ReplaySlider::timeAt(int x) const {
  const double share = static_cast<double>(x - kHandleMargin) / std::max(1, width() - 2 * kHandleMargin);
  return std::clamp(share, 0.0, 1.0) * duration_;
}

int ReplaySlider::placeOf(double time) const {
  const double share = duration_ > 0 ? std::clamp(time / duration_, 0.0, 1.0) : 0;
  return kHandleMargin + static_cast<int>(std::lround(share * (width() - 2 * kHandleMargin)));
}

void ReplaySlider::paintEvent(QPaintEvent*) {
  QPainter painter(this);
  painter.setRenderHint(QPainter::Antialiasing);
  const QRect bar(kHandleMargin, kTop, width() - 2 * kHandleMargin, kBar);
  painter.setPen(Qt::NoPen);
  painter.setBrush(palette().color(QPalette::Mid));
  painter.drawRoundedRect(bar, 3, 3);
  painter.setBrush(palette().color(QPalette::Highlight));
  painter.drawRoundedRect(QRect(bar.left(), bar.top(), placeOf(time_) - bar.left(), kBar), 3, 3);
  int free_from = 0;  // where the name of a phase does not cover another one
  for (const Mark& mark : marks_) {
    const int x = placeOf(mark.time);
    painter.setPen(QPen(palette().color(QPalette::WindowText), mark.is_phase ? 2 : 1));
    painter.drawLine(x, mark.is_phase ? kTop - 6 : kTop + kBar, x, mark.is_phase ? kTop + kBar : kTop + kBar + 6);
    if (!mark.is_phase || x < free_from) continue;
    painter.drawText(std::min(x, width() - fontMetrics().horizontalAdvance(mark.text)), kTop - 8, mark.text);
    free_from = x + fontMetrics().horizontalAdvance(mark.text + "  ");
  }
  painter.setPen(QPen(palette().color(QPalette::WindowText), 1));
  painter.setBrush(palette().color(QPalette::Button));
  painter.drawEllipse(QPoint(placeOf(time_), kTop + kBar / 2), 6, 6);
}

void ReplaySlider::drag(int x, bool exact) {
  time_ = timeAt(x);
  update();
  seek_(time_, exact);
}

void ReplaySlider::mousePressEvent(QMouseEvent* event) {
  if (event->button() != Qt::LeftButton || !(duration_ > 0)) return;
  dragged_ = true;
  drag(event->x(), false);
}

void ReplaySlider::mouseMoveEvent(QMouseEvent* event) {
  if (dragged_) drag(event->x(), false);
}

void ReplaySlider::mouseReleaseEvent(QMouseEvent* event) {
  if (!dragged_ || event->button() != Qt::LeftButton) return;
  dragged_ = false;
  drag(event->x(), true);
}

bool ReplaySlider::event(QEvent* event) {
  if (event->type() != QEvent::ToolTip) return QWidget::event(event);
  const auto* help = static_cast<QHelpEvent*>(event);
  QString text = QString("%1 s").arg(timeAt(help->x()), 0, 'f', 1);
  for (const Mark& mark : marks_)
    if (std::abs(placeOf(mark.time) - help->x()) <= kNear)
      text += QString("\n%1 s: %2").arg(mark.time, 0, 'f', 1).arg(mark.text);
  QToolTip::showText(help->globalPos(), text, this);
  return true;
}

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

/// Plays, pauses and scrubs a recording that vibe_player has open.
class ReplayPanel : public rviz::Panel {
  Q_OBJECT
 public:
  explicit ReplayPanel(QWidget* parent = nullptr)
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

  void onInitialize() override {
    ros::NodeHandle handle;
    commands_ = handle.advertise<vibe_msgs::ReplayCommand>("replay/command", 10);
    statuses_ = handle.subscribe("replay/status", 10, &ReplayPanel::display, this);
  }

 private:
  ReplaySlider* slider_;
  QPushButton* play_;
  QComboBox* rate_;
  QLabel *time_, *state_;
  ros::Publisher commands_;
  ros::Subscriber statuses_;
  vibe_msgs::ReplayStatus status_;

  void display(const vibe_msgs::ReplayStatus& status) {
    status_ = status;
    setEnabled(true);
    play_->setText(status.playing ? "Pause" : "Play");
    time_->setText(minutes(status.time) + " of " + minutes(status.duration));
    slider_->display(status.time, status.duration, marksOf(status));
    const QString name = QFileInfo(QString::fromStdString(status.file)).fileName();
    state_->setText(name + comparison(status));
  }

  void command(bool play, double seek, bool exact) {
    vibe_msgs::ReplayCommand message;
    message.play = play;
    message.rate = rate();
    message.seek = seek;
    message.exact = exact;
    commands_.publish(message);
  }

  double rate() const { return rate_->currentData().toDouble(); }
};

}  // namespace vibe::rviz_plugins

PLUGINLIB_EXPORT_CLASS(vibe::rviz_plugins::ReplayPanel, rviz::Panel)

#include "replay_panel.moc"
