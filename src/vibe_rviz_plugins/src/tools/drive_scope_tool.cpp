#include "tools/drive_scope_tool.hpp"

#include <OgreViewport.h>
#include <rviz/display_context.h>
#include <rviz/properties/bool_property.h>
#include <rviz/properties/float_property.h>
#include <rviz/properties/string_property.h>
#include <rviz/render_panel.h>
#include <rviz/tool_manager.h>
#include <rviz/view_controller.h>
#include <rviz/view_manager.h>
#include <rviz/viewport_mouse_event.h>

#include <QKeyEvent>
#include <QTimer>
#include <pluginlib/class_list_macros.hpp>

#include "messages/command_messages.hpp"
#include "overlay/legend.hpp"
#include "panels/procedure_subscriptions.hpp"

namespace vibe::rviz_plugins {
namespace {

constexpr double kOverlayPeriod = 0.1;                                                           // [s]
constexpr int kButtonPeriod = 100;                                                               // [ms]
constexpr double kDegree = 0.017453292519943295, kTurn = 6.283185307179586, kMillimetre = 1e-3;  // in SI units
const char* const kHowTo =
    "Keys and mouse drive the endoscope. H: help. Right and middle mouse button: move the view. Esc: leave.";
constexpr double kNotch = 120;  // of a mouse wheel, in eighths of a degree

void describe(const vibe_msgs::ProcedureState& state, DriveHud& hud) {
  hud.pressure = state.pressure;
  hud.tissue = state.held_particles > 0 ? "held" : hud.force > 0 ? "touched" : "not touched";
  hud.needle = !state.needle_loaded ? "none" : state.needle_on_arm ? "on the arm" : "in the exchange";
  hud.bites = std::to_string(state.bites);
}

rviz::RenderPanel* renderPanel(rviz::DisplayContext* context) {
  return context->getViewManager()->getRenderPanel();
}

}  // namespace

DriveScopeTool::DriveScopeTool()
    : sender_([this](int button, bool down) { button_changes_.emplace_back(button, down); }),
      buttons_("drive_scope"),
      button_timer_(new QTimer(this)) {
  shortcut_key_ = 'd';
  access_all_keys_ = true;  // the keys of other tools drive too; Esc leaves
  makeProperties();
  connect(button_timer_, SIGNAL(timeout()), this, SLOT(tickButtons()));
}

DriveScopeTool::~DriveScopeTool() = default;

void DriveScopeTool::makeProperties() {
  rviz::Property* all = getPropertyContainer();
  namespace_ =
      new rviz::StringProperty("Namespace", "", "Namespace of the topics of the simulator; empty: that of rviz.", all,
                               SLOT(connectAgain()), this);
  at_start_ = new rviz::BoolProperty("Active at start", false,
                                     "Whether rviz begins with this tool when it opens this configuration.", all);
  help_ = new rviz::BoolProperty("Help", true, "Shows keys, joints and the next step in the view; keys H and F1.", all,
                                 SLOT(changeHelp()), this);
  speeds_ = {makeSpeed("Insertion", 30, "Speed of insertion while a key is held [mm/s].", 1000),
             makeSpeed("Rotation", 45, "Speed of rotation while a key is held [deg/s].", 1000),
             makeSpeed("Tip", 35, "Speed of the tip's bending while a key is held [deg/s].", 1000),
             makeSpeed("Helix", 15, "Speed of the helix, out and in, while a key is held [mm/s].", 1000),
             makeSpeed("Helix turns", 2, "Speed of the turning helix while a key is held [turns/s].", 100),
             makeSpeed("Needle arm", 30, "Speed of the needle arm while a key is held [mm/s].", 1000)};
  slow_ = makeSpeed("Slow factor", 0.25, "Speed with Shift or key 1, as a multiple of the normal speed.", 1);
  fast_ = makeSpeed("Fast factor", 2.5, "Speed with key 3, as a multiple of the normal speed.", 20);
  bend_ = makeSpeed("Bending by mouse", 0.3, "How far the tip bends when the mouse is dragged by a pixel [deg].", 10);
  wheel_ = makeSpeed("Insertion by wheel", 2, "How far a notch of the mouse wheel inserts the endoscope [mm].", 50);
}

rviz::FloatProperty* DriveScopeTool::makeSpeed(const char* name, double value, const char* help, double most) {
  auto* property =
      new rviz::FloatProperty(name, static_cast<float>(value), QString(help) + " The limits of the URDF apply on top.",
                              getPropertyContainer(), SLOT(changeSpeeds()), this);
  property->setMin(0.01F);
  property->setMax(static_cast<float>(most));
  return property;
}

void DriveScopeTool::onInitialize() {
  changeSpeeds();
}

void DriveScopeTool::load(const rviz::Config& config) {
  Tool::load(config);
  if (!at_start_->getBool()) return;
  // the other tools of the configuration come after this one
  QTimer::singleShot(0, this, [this] { context_->getToolManager()->setCurrentTool(this); });
}

void DriveScopeTool::changeSpeeds() {
  const auto value = [](const rviz::FloatProperty* property) { return static_cast<double>(property->getFloat()); };
  const double tip = value(speeds_[2]) * kDegree;
  DriveSpeeds speeds;
  speeds.keys = {
      value(speeds_[0]) * kMillimetre, value(speeds_[1]) * kDegree,    tip, tip, value(speeds_[3]) * kMillimetre,
      value(speeds_[4]) * kTurn,       value(speeds_[5]) * kMillimetre};
  speeds.slow = value(slow_);
  speeds.fast = value(fast_);
  sender_.setSpeeds(speeds);
}

void DriveScopeTool::activate() {
  active_ = true;
  window_ = renderPanel(context_);
  if (window_) {
    window_->installEventFilter(this);
    window_->setFocus(Qt::OtherFocusReason);
  }
  connectAgain();
  button_timer_->start(kButtonPeriod);
}

void DriveScopeTool::deactivate() {
  releaseAll();
  active_ = false;
  if (window_) window_->removeEventFilter(this);  // rviz destroys the window before the tools
  sender_.stop();
  buttons_.setControl(false, steadySeconds());
  hideOverlay();
}

void DriveScopeTool::connectAgain() {
  if (!active_) return;
  releaseAll();
  const std::string name_space = namespace_->getStdString();
  name_space_trouble_ = checkNamespace(name_space);
  if (!name_space_trouble_.empty()) return sender_.stop();
  buttons_.listen(name_space);
  sender_.start(name_space);
}

bool DriveScopeTool::eventFilter(QObject* watched, QEvent* event) {
  switch (event->type()) {
    case QEvent::KeyPress:
    case QEvent::KeyRelease:
      if (handleKey(*static_cast<QKeyEvent*>(event))) return true;
      break;
    case QEvent::ShortcutOverride:  // a shortcut of one key must not take it away
      if (isOurs(*static_cast<QKeyEvent*>(event))) return event->accept(), true;
      break;
    case QEvent::FocusOut:
    case QEvent::WindowDeactivate:
    case QEvent::Hide:
      releaseAll();
      break;
    default:
      break;
  }
  return Tool::eventFilter(watched, event);
}

bool DriveScopeTool::isOurs(const QKeyEvent& event) const {
  if ((event.modifiers() & (Qt::ControlModifier | Qt::AltModifier | Qt::MetaModifier)) != 0) return false;
  const int key = event.key();
  return findBinding(key) != nullptr || key == Qt::Key_H || key == Qt::Key_F1 || key == Qt::Key_V;
}

/// @return whether rviz must not see the event
bool DriveScopeTool::handleKey(const QKeyEvent& event) {
  const bool down = event.type() == QEvent::KeyPress;
  // Ctrl may have been pressed since the key went down: a release always counts
  if (down && !isOurs(event)) return false;
  if (event.isAutoRepeat()) return isOurs(event);
  if (down && (event.key() == Qt::Key_H || event.key() == Qt::Key_F1)) help_->setBool(!help_->getBool());
  if (down && event.key() == Qt::Key_V) showNextView();
  if (down)
    sender_.keyDown(event.key());
  else
    sender_.keyUp(event.key());
  passButtons();
  return isOurs(event);
}

/// Of the saved views of rviz.
void DriveScopeTool::showNextView() {
  rviz::ViewManager& views = *context_->getViewManager();
  if (views.getNumViews() == 0) return setStatus("There are no saved views; save some in the panel 'Views'.");
  view_ = (view_ + 1) % views.getNumViews();
  views.setCurrentFrom(views.getViewAt(view_));
}

void DriveScopeTool::releaseAll() {
  sender_.releaseAll();
  passButtons();
}

void DriveScopeTool::passButtons() {
  if (button_changes_.empty()) return;
  const Moment now = moment(sender_.view());
  for (const auto& [button, down] : button_changes_)
    if (down)
      buttons_.press(button, now);
    else
      buttons_.release(button, now);
  button_changes_.clear();
}

Moment DriveScopeTool::moment(const ScopeSender::View& view) const {
  Moment now;
  now.wall = steadySeconds();
  now.stamp = ros::Time::now().toSec();
  if (!view.state) return now;
  now.step_period = view.state->step_period;
  now.step = view.state->step;
  now.paused = view.state->paused;
  return now;
}

/// Ten times a second. After the tool was left, until the last message is sent.
void DriveScopeTool::tickButtons() {
  const ScopeSender::View view = sender_.view();
  const Moment now = moment(view);
  const bool control = active_ && view.driving;
  if (control != buttons_.inControl()) buttons_.setControl(control, now.wall);
  if (!now.paused || !buttons_.inControl()) buttons_.tick(now);  // during a pause only presses are published
  if (!active_ && !buttons_.closing()) button_timer_->stop();
}

int DriveScopeTool::processMouseEvent(rviz::ViewportMouseEvent& event) {
  if (event.wheel_delta != 0) {
    const double notches = event.wheel_delta / kNotch;
    sender_.displace(Insertion, notches * kMillimetre * static_cast<double>(wheel_->getFloat()));
    return Render;
  }
  if (event.left() && event.type == QEvent::MouseMove) {
    const double by = kDegree * static_cast<double>(bend_->getFloat());
    sender_.displace(TipUpDown, by * (event.last_y - event.y));
    sender_.displace(TipLeftRight, by * (event.last_x - event.x));
    return Render;
  }
  const bool of_view = event.middle() || event.right() || event.acting_button != Qt::NoButton;
  if (!of_view || event.left() || event.panel->getViewController() == nullptr) return 0;
  if (event.acting_button == Qt::LeftButton) return 0;
  event.panel->getViewController()->handleMouseEvent(event);
  return Render;
}

void DriveScopeTool::update(float, float) {
  const double now = steadySeconds();
  if (now - drawn_ < kOverlayPeriod) return;
  drawn_ = now;
  const DriveHud hud = hudOf(sender_.view());
  draw(hud);
  setStatus(hud.trouble.empty() ? kHowTo : QString::fromStdString(hud.trouble));
}

DriveHud DriveScopeTool::hudOf(const ScopeSender::View& view) const {
  DriveHud hud;
  hud.keys_down = view.keys_down;
  hud.gear = view.gear;
  hud.joints = view.joints;
  hud.limits = view.limits;
  hud.force = view.force;
  for (std::size_t i = 0; i < hud.buttons.size(); ++i) hud.buttons[i] = buttons_.down()[i] != 0;
  hud.trouble = name_space_trouble_.empty() ? view.trouble : name_space_trouble_;
  if (!view.state) return hud;
  describe(*view.state, hud);
  if (hud.trouble.empty() && view.state->paused) hud.trouble = "The simulator is paused. Resume it to drive.";
  if (hud.trouble.empty() && view.driving && !buttons_.inControl() && !buttons_.isTakingControl())
    hud.trouble = "No buttons: " + buttons_.sentence(steadySeconds());
  if (hud.trouble.empty() && !renderPanel(context_)->hasFocus())
    hud.trouble = "The keyboard is elsewhere. Move the mouse over this view, or click into it.";
  DriveSituation situation = situationOf(*view.state);
  situation.touches = situation.touches || hud.force > 0;  // the state tells of gas first
  situation.joints = hud.joints;
  situation.closed = hud.limits[NeedleDriver].upper;
  situation.gas_on = hud.buttons[5];
  hud.step = firstStep(situation);
  return hud;
}

void DriveScopeTool::draw(const DriveHud& hud) {
  const rviz::RenderPanel* panel = renderPanel(context_);
  const Ogre::Viewport* viewport = panel != nullptr ? panel->getViewport() : nullptr;
  if (viewport == nullptr) return;
  const int width = viewport->getActualWidth(), height = viewport->getActualHeight();
  const bool help = help_->getBool();
  const double scale = overlayScale(width, height);
  if (!banner_) {
    banner_ = std::make_unique<Legend>(Legend::Place::TopCentre);
    keys_ = std::make_unique<Legend>(Legend::Place::TopLeft);
    state_ = std::make_unique<Legend>(Legend::Place::TopRight);
  }
  if (!help && hud.trouble.empty()) return hideOverlay();
  const QImage banner = drawnBanner(hud, scale, width);
  banner_->show(banner);
  if (!help) return keys_->hide(), state_->hide();
  const int below = banner.height() + static_cast<int>(6 * scale);
  const QImage keys = drawnKeys(hud, scale), state = drawnState(hud, scale);
  keys_->show(keys, below);
  if (sitBeside(keys, state, width))
    state_->show(state, below);
  else
    state_->hide();
}

void DriveScopeTool::changeHelp() {
  drawn_ = 0;  // at once
}

void DriveScopeTool::hideOverlay() {
  for (Legend* legend : {banner_.get(), keys_.get(), state_.get()})
    if (legend != nullptr) legend->hide();
}

}  // namespace vibe::rviz_plugins

PLUGINLIB_EXPORT_CLASS(vibe::rviz_plugins::DriveScopeTool, rviz::Tool)
