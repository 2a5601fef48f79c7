#include "panels/procedure_panel.hpp"

#include <QLabel>
#include <QLineEdit>
#include <QPushButton>
#include <QScrollArea>
#include <QTimer>
#include <QVBoxLayout>

#include <rviz/view_controller.h>
#include <rviz/view_manager.h>
#include <rviz/visualization_manager.h>

#include <pluginlib/class_list_macros.hpp>

#include "panels/control_boxes.hpp"
#include "panels/measures_view.hpp"
#include "panels/panel_style.hpp"
#include "panels/procedure_tables.hpp"
#include "panels/record_box.hpp"
#include "panels/status_summary.hpp"
#include "vibe_operator/messages/procedure_text.hpp"

namespace vibe::rviz_plugins {

namespace {

constexpr int kMinWidth = 260;                                // nothing is clipped [px]
constexpr int kPreferredWidth = 340, kPreferredHeight = 640;  // [px]
const char* const kEndoscopeView = "vibe_rviz_plugins/Endoscope";
constexpr int kPeriod = 100;  // of refresh() and of the buttons' messages [ms]

void addPart(QVBoxLayout* column, const QString& title, QWidget* part) {
  QLabel* label = wrappingLabel();
  label->setText(title);
  QFont font = label->font();
  font.setBold(true);
  label->setFont(font);
  auto* line = new QFrame;
  line->setFrameShape(QFrame::HLine);
  line->setFrameShadow(QFrame::Sunken);
  column->addWidget(line);
  column->addWidget(label);
  column->addWidget(part);
}

}  // namespace

ProcedureWidget::ProcedureWidget(QWidget* parent)
    : QWidget(parent),
      status_(wrappingLabel()),
      summary_(new StatusSummary),
      commands_(makeCommands()),
      stepping_(makeStepping()),
      recording_(new RecordBox),
      sutures_(new SutureTable),
      trainee_(wrappingLabel()),
      measures_(new MeasuresView),
      events_(new EventList),
      solver_statistics_(new SolverStatisticsView),
      name_space_edit_(new QLineEdit),
      subscriptions_([this](const vibe_msgs::ProcedureEvent& event) { events_->add(event, subscriptions_.origin()); }),
      // the answer comes in another thread and is shown in this one
      caller_([this](const ServiceCaller::Answer& answer) {
        QMetaObject::invokeMethod(
            this, [this, answer] { takeAnswer(answer); }, Qt::QueuedConnection);
      }) {
  status_->setObjectName("status");
  auto* scroll = new QScrollArea;
  scroll->setWidgetResizable(true);
  scroll->setFrameShape(QFrame::NoFrame);
  scroll->setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
  scroll->setWidget(makeContent());
  auto* column = new QVBoxLayout(this);
  column->setContentsMargins(4, 4, 4, 4);
  column->addWidget(status_);
  column->addWidget(scroll);
  status_->hide();
  setMinimumWidth(kMinWidth);
}

ProcedureWidget::~ProcedureWidget() = default;

QSize ProcedureWidget::sizeHint() const {
  return {kPreferredWidth, kPreferredHeight};
}

QWidget* ProcedureWidget::makeContent() {
  auto* content = new QWidget;
  auto* column = new QVBoxLayout(content);
  column->setContentsMargins(0, 0, 4, 0);
  column->addWidget(summary_);
  addPart(column, "Events", events_);
  addPart(column, "Buttons", commands_);
  addPart(column, "Simulation", stepping_);
  addPart(column, "Recording", recording_);
  addPart(column, "Sutures", sutures_);
  trainee_->setObjectName("trainee");
  addPart(column, "Goals of the trainee", trainee_);
  addPart(column, "Measures and published references", measures_);
  addPart(column, "Simulator", solver_statistics_);
  name_space_edit_->setObjectName("namespace");
  name_space_edit_->setPlaceholderText("that of rviz");
  name_space_edit_->setToolTip("Namespace of the topics of the simulator, for example /room1; empty: that of rviz.");
  QObject::connect(name_space_edit_, &QLineEdit::editingFinished, this, [this] {
    if (name_space_edit_->text() == name_space_) return;
    setNamespace(name_space_edit_->text());
    if (namespace_changed_) namespace_changed_();
  });
  addPart(column, "Namespace", name_space_edit_);
  column->addStretch(1);
  return content;
}

CommandBox* ProcedureWidget::makeCommands() {
  CommandBox::Actions actions;
  actions.control = [this](bool on) {
    sender_.setControl(on, operating::steadySeconds());
    refresh();
  };
  actions.press = [this](int button) {
    sender_.press(button, moment());
    refresh();
  };
  actions.release = [this](int button) { sender_.release(button, moment()); };
  return new CommandBox(std::move(actions));
}

SteppingBox* ProcedureWidget::makeStepping() {
  SteppingBox::Actions actions;
  actions.pause = [this](bool paused) {
    callService("pause", [this, paused](const std::string& name) { return caller_.pause(name, paused); });
  };
  actions.step = [this](unsigned n) {
    callService("step", [this, n](const std::string& name) { return caller_.step(name, n); });
  };
  actions.reset = [this] { callService("reset", [this](const std::string& name) { return caller_.reset(name); }); };
  actions.stop_waiting = [this] { gives_up_ = true; };
  return new SteppingBox(std::move(actions));
}

void ProcedureWidget::start() {
  setNamespace(name_space_);
  auto* timer = new QTimer(this);
  QObject::connect(timer, &QTimer::timeout, this, [this] {
    sender_.tick(moment());
    if (gives_up_) caller_.giveUp();
    if (isVisible()) refresh();
  });
  timer->start(kPeriod);
}

void ProcedureWidget::setNamespace(const QString& name) {
  wrong_namespace_ = operating::checkNamespace(name.toStdString());
  if (!wrong_namespace_.empty()) return;
  name_space_ = name;
  name_space_edit_->setText(name);
  events_->clear();
  subscriptions_.listen(name.toStdString());
  sender_.listen(name.toStdString());
  recording_->setNamespace(name.toStdString());
  refresh();
}

operating::Moment ProcedureWidget::moment() const {
  operating::Moment now;
  now.wall = operating::steadySeconds();
  now.stamp = ros::Time::now().toSec();
  if (const auto& state = subscriptions_.messages().state) {
    now.step_period = state->step_period;
    now.step = state->step;
    now.paused = state->paused;
  }
  return now;
}

std::string ProcedureWidget::fullName(const std::string& service) const {
  return ros::NodeHandle(name_space_.toStdString()).resolveName(service);
}

void ProcedureWidget::callService(const std::string& service, const std::function<bool(const std::string&)>& call) {
  const std::string name = fullName(service);
  if (!call(name)) return;
  waited_for_ = name;
  waits_since_ = operating::steadySeconds();
  gives_up_ = false;
  stepping_->displayWaiting(name, 0);
}

void ProcedureWidget::takeAnswer(const ServiceCaller::Answer& answer) {
  waited_for_.clear();
  gives_up_ = false;
  stepping_->displayAnswer(answer.success, answer.sentence);
}

void ProcedureWidget::refresh() {
  const double now = operating::steadySeconds();
  displayStatus(now);
  const PanelMessages& messages = subscriptions_.messages();
  const bool may_take = sender_.mayTakeControl(now) && subscriptions_.problem(now).empty();
  commands_->display(sender_.inControl() || sender_.isTakingControl(), may_take, sender_.down(), sender_.sentence(now));
  stepping_->displayState(static_cast<bool>(messages.state), messages.state && messages.state->paused);
  if (!waited_for_.empty()) stepping_->displayWaiting(waited_for_, now - waits_since_);
  recording_->refresh();
  summary_->display(messages);
  sutures_->display(messages.sutures ? operating::sutureRows(*messages.sutures, messages.progress.get())
                                     : std::vector<operating::SutureRow>());
  trainee_->setText(toQt(messages.progress ? operating::traineeText(*messages.progress) : "no trainee with goals"));
  measures_->display(messages);
  solver_statistics_->display(messages, subscriptions_.freshness(now));
}

void ProcedureWidget::displayStatus(double now) {
  const std::string sentence = wrong_namespace_.empty() ? subscriptions_.problem(now) : wrong_namespace_;
  QPalette colours = palette();
  colours.setColor(QPalette::WindowText, warningColour(colours));
  status_->setPalette(colours);
  status_->setText(toQt(sentence));
  status_->setVisible(!sentence.empty());
}

ProcedurePanel::ProcedurePanel(QWidget* parent)
    : rviz::Panel(parent), endoscope_(new QPushButton("Endoscope's picture")), widget_(new ProcedureWidget) {
  endoscope_->setCheckable(true);
  endoscope_->setToolTip("Looks through the endoscope instead of at the organ from outside.");
  connect(endoscope_, &QPushButton::clicked, this, &ProcedurePanel::lookThroughEndoscope);
  auto* column = new QVBoxLayout(this);
  column->setContentsMargins(0, 0, 0, 0);
  column->addWidget(endoscope_);
  column->addWidget(widget_);
  widget_->onNamespaceChanged([this] { Q_EMIT configChanged(); });
}

void ProcedurePanel::onInitialize() {
  widget_->start();
  rviz::ViewManager* views = vis_manager_->getViewManager();
  connect(views, &rviz::ViewManager::currentChanged, this,
          [this, views] { endoscope_->setChecked(views->getCurrent()->getClassId() == kEndoscopeView); });
}

/// A saved view, so that it is where the configuration has it, else one of that kind.
void ProcedurePanel::lookThroughEndoscope(bool on) {
  rviz::ViewManager& views = *vis_manager_->getViewManager();
  for (int k = 0; k < views.getNumViews(); ++k)
    if ((views.getViewAt(k)->getClassId() == kEndoscopeView) == on) return views.setCurrentFrom(views.getViewAt(k));
  views.setCurrentViewControllerType(on ? kEndoscopeView : "rviz/Orbit");
}

void ProcedurePanel::load(const rviz::Config& config) {
  rviz::Panel::load(config);
  QString name;
  if (config.mapGetString("Namespace", &name)) widget_->setNamespace(name);
}

void ProcedurePanel::save(rviz::Config config) const {
  rviz::Panel::save(config);
  config.mapSetValue("Namespace", widget_->nameSpace());
}

}  // namespace vibe::rviz_plugins

PLUGINLIB_EXPORT_CLASS(vibe::rviz_plugins::ProcedurePanel, rviz::Panel)
