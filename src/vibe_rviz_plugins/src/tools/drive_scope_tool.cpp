#include <OgreViewport.h>
#include <rviz/display_context.h>
#include <rviz/properties/bool_property.h>
#include <rviz/properties/float_property.h>
#include <rviz/properties/string_property.h>
#include <rviz/render_panel.h>
#include <rviz/tool.h>
#include <rviz/tool_manager.h>
#include <rviz/view_controller.h>
#include <rviz/view_manager.h>
#include <rviz/viewport_mouse_event.h>
#include <QKeyEvent>
#include <QPointer>
#include <QTimer>
#include <QWidget>
#include <map>
#include <memory>
#include <pluginlib/class_list_macros.hpp>
#include <string>

#include "overlay/drive_overlay.hpp"
#include "overlay/legend.hpp"
#include "vibe_operator/driving/manual_drive.hpp"
#include "vibe_operator/messages/session_watch.hpp"

namespace vibe::rviz_plugins {
namespace {

// the keys of Qt are passed on as they are
static_assert(operating::keys::kSpace == Qt::Key_Space && operating::keys::kEscape == Qt::Key_Escape &&
              operating::keys::kShift == Qt::Key_Shift && operating::keys::kLeft == Qt::Key_Left &&
              operating::keys::kUp == Qt::Key_Up && operating::keys::kRight == Qt::Key_Right &&
              operating::keys::kDown == Qt::Key_Down && 'A' == Qt::Key_A && '1' == Qt::Key_1);

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

/// Drives the scope and the suturing device with keys and mouse in the render window, with an overlay that explains
/// the keys. Publishes only while it is the active tool.
class DriveScopeTool : public rviz::Tool {
  Q_OBJECT

 public:
  DriveScopeTool() : drive_("drive_scope"), button_timer_(new QTimer(this)) {
    shortcut_key_ = 'd';
    access_all_keys_ = true;  // the keys of other tools drive too; Esc leaves
    makeProperties();
    connect(button_timer_, SIGNAL(timeout()), this, SLOT(tickButtons()));
  }

  ~DriveScopeTool() override = default;

  void onInitialize() override { changeSpeeds(); }

  void activate() override {
    active_ = true;
    window_ = renderPanel(context_);
    if (window_) {
      window_->installEventFilter(this);
      window_->setFocus(Qt::OtherFocusReason);
    }
    connectAgain();
    button_timer_->start(kButtonPeriod);
  }

  void deactivate() override {
    active_ = false;
    if (window_) window_->removeEventFilter(this);  // rviz destroys the window before the tools
    drive_.stop();
    hideOverlay();
  }

  void update(float, float) override {
    const double now = operating::steadySeconds();
    if (now - drawn_ < kOverlayPeriod) return;
    drawn_ = now;
    const DriveHud hud = hudOf(drive_.view());
    draw(hud);
    setStatus(hud.trouble.empty() ? kHowTo : QString::fromStdString(hud.trouble));
  }

  void load(const rviz::Config& config) override {
    Tool::load(config);
    if (!at_start_->getBool()) return;
    // the other tools of the configuration come after this one
    QTimer::singleShot(0, this, [this] { context_->getToolManager()->setCurrentTool(this); });
  }

  int processMouseEvent(rviz::ViewportMouseEvent& event) override {
    if (event.wheel_delta != 0) {
      const double notches = event.wheel_delta / kNotch;
      drive_.displace(operating::Insertion, notches * kMillimetre * static_cast<double>(wheel_->getFloat()));
      return Render;
    }
    if (event.left() && event.type == QEvent::MouseMove) {
      const double by = kDegree * static_cast<double>(bend_->getFloat());
      drive_.displace(operating::TipUpDown, by * (event.last_y - event.y));
      drive_.displace(operating::TipLeftRight, by * (event.last_x - event.x));
      return Render;
    }
    const bool of_view = event.middle() || event.right() || event.acting_button != Qt::NoButton;
    if (!of_view || event.left() || event.panel->getViewController() == nullptr) return 0;
    if (event.acting_button == Qt::LeftButton) return 0;
    event.panel->getViewController()->handleMouseEvent(event);
    return Render;
  }

  /// Of the render window: rviz passes no key releases to tools.
  bool eventFilter(QObject* watched, QEvent* event) override {
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
        drive_.releaseAll();
        pressed_.clear();
        break;
      default:
        break;
    }
    return Tool::eventFilter(watched, event);
  }

 private Q_SLOTS:
  void connectAgain() {
    if (active_) drive_.start(namespace_->getStdString());
  }

  void changeSpeeds() {
    const auto value = [](const rviz::FloatProperty* property) { return static_cast<double>(property->getFloat()); };
    const double tip = value(speeds_[2]) * kDegree;
    operating::DriveSpeeds speeds;
    speeds.keys = {
        value(speeds_[0]) * kMillimetre, value(speeds_[1]) * kDegree,    tip, tip, value(speeds_[3]) * kMillimetre,
        value(speeds_[4]) * kTurn,       value(speeds_[5]) * kMillimetre};
    speeds.slow = value(slow_);
    speeds.fast = value(fast_);
    drive_.setSpeeds(speeds);
  }

  void changeHelp() {
    drawn_ = 0;  // at once
  }

  /// After the tool was left, until the last message is sent.
  void tickButtons() {
    drive_.tick();
    if (drive_.isSilent()) button_timer_->stop();
  }

 private:
  void makeProperties() {
    rviz::Property* all = getPropertyContainer();
    namespace_ =
        new rviz::StringProperty("Namespace", "", "Namespace of the topics of the simulator; empty: that of rviz.", all,
                                 SLOT(connectAgain()), this);
    at_start_ = new rviz::BoolProperty("Active at start", false,
                                       "Whether rviz begins with this tool when it opens this configuration.", all);
    help_ = new rviz::BoolProperty("Help", true, "Shows keys, joints and the next step in the view; keys H and F1.",
                                   all, SLOT(changeHelp()), this);
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

  rviz::FloatProperty* makeSpeed(const char* name, double value, const char* help, double most) {
    auto* property = new rviz::FloatProperty(name, static_cast<float>(value),
                                             QString(help) + " The limits of the URDF apply on top.",
                                             getPropertyContainer(), SLOT(changeSpeeds()), this);
    property->setMin(0.01F);
    property->setMax(static_cast<float>(most));
    return property;
  }

  /// @return whether rviz must not see the event
  bool handleKey(const QKeyEvent& event) {
    const bool down = event.type() == QEvent::KeyPress;
    // Ctrl may have been pressed since the key went down: a release always counts
    if (down && !isOurs(event)) return false;
    if (event.isAutoRepeat()) return isOurs(event);
    if (down && (event.key() == Qt::Key_H || event.key() == Qt::Key_F1)) help_->setBool(!help_->getBool());
    if (down && event.key() == Qt::Key_V) showNextView();
    const quint32 code = event.nativeScanCode();  // 0: unknown
    if (down) {
      pressed_[code] = event.key();
      drive_.keyDown(event.key());
    } else {
      const auto pressed = pressed_.extract(code);
      drive_.keyUp(code == 0 || pressed.empty() ? event.key() : pressed.mapped());
    }
    return isOurs(event);
  }

  bool isOurs(const QKeyEvent& event) const {
    if ((event.modifiers() & (Qt::ControlModifier | Qt::AltModifier | Qt::MetaModifier)) != 0) return false;
    const int key = event.key();
    return operating::findBinding(key) != nullptr || key == Qt::Key_H || key == Qt::Key_F1 || key == Qt::Key_V;
  }

  /// Of the saved views of rviz.
  void showNextView() {
    rviz::ViewManager& views = *context_->getViewManager();
    if (views.getNumViews() == 0) return setStatus("There are no saved views; save some in the panel 'Views'.");
    view_ = (view_ + 1) % views.getNumViews();
    views.setCurrentFrom(views.getViewAt(view_));
  }

  DriveHud hudOf(const operating::DriveView& view) const {
    DriveHud hud;
    static_cast<operating::DriveView&>(hud) = view;
    if (!view.state) return hud;
    describe(*view.state, hud);
    if (hud.trouble.empty() && !renderPanel(context_)->hasFocus())
      hud.trouble = "The keyboard is elsewhere. Move the mouse over this view, or click into it.";
    return hud;
  }

  void draw(const DriveHud& hud) {
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

  void hideOverlay() {
    for (Legend* legend : {banner_.get(), keys_.get(), state_.get()})
      if (legend != nullptr) legend->hide();
  }

  rviz::StringProperty* namespace_;
  rviz::BoolProperty *at_start_, *help_;
  std::array<rviz::FloatProperty*, 6> speeds_{};
  rviz::FloatProperty *slow_, *fast_, *bend_, *wheel_;

  operating::ManualDrive drive_;
  std::map<quint32, int> pressed_;  // keys by the code of their place, which Shift and layouts leave as it is
  QTimer* button_timer_;
  std::unique_ptr<Legend> banner_, keys_, state_;
  int view_ = 0;              // the saved view that was chosen last
  QPointer<QWidget> window_;  // whose keys it hears while it is active
  double drawn_ = 0;          // time of the last overlay, steady clock [s]
  bool active_ = false;
};

}  // namespace vibe::rviz_plugins

PLUGINLIB_EXPORT_CLASS(vibe::rviz_plugins::DriveScopeTool, rviz::Tool)

#include "drive_scope_tool.moc"
