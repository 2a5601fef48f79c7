// The whole panel with topics and services, without rviz and without a display.
#include <gtest/gtest.h>
#include <ros/callback_queue.h>
#include <ros/ros.h>
#include <sensor_msgs/Joy.h>
#include <std_srvs/SetBool.h>
#include <vibe_msgs/ProcedureState.h>
#include <vibe_msgs/Reset.h>
#include <vibe_msgs/Step.h>
#include <vibe_msgs/StepInput.h>

#include <QElapsedTimer>
#include <QLineEdit>
#include <QPushButton>
#include <QTimer>
#include <atomic>
#include <thread>

#include "offscreen.hpp"
#include "panels/procedure_panel.hpp"

namespace vibe::rviz_plugins {
namespace {

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

/// Runs the widgets and the callbacks until it holds, or for so long.
bool waitFor(double seconds, const std::function<bool()>& holds) {
  QElapsedTimer timer;
  timer.start();
  while (!holds()) {
    if (static_cast<double>(timer.elapsed()) > 1e3 * seconds) return false;
    QCoreApplication::processEvents();
    ros::spinOnce();
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  return true;
}

void click(QWidget& widget, const QString& text) {
  for (auto* button : widget.findChildren<QPushButton*>()) {
    if (button->text() != text) continue;
    EXPECT_TRUE(button->isEnabled()) << text.toStdString();
    return button->click();
  }
  ADD_FAILURE() << "no button " << text.toStdString();
}

/// A simulator's services, in threads of their own as there.
/// Whether control can be taken within some seconds of a simulator in this namespace, which sends states.
bool mayTakeControl(const QWidget& widget, const std::string& name_space, double seconds) {
  ros::Publisher publisher = ros::NodeHandle(name_space).advertise<vibe_msgs::ProcedureState>("procedure/state", 1);
  return waitFor(seconds, [&] {
    publisher.publish(vibe_msgs::ProcedureState());
    return widget.findChild<QPushButton*>("control")->isEnabled();
  });
}

class Services {
 public:
  explicit Services(const std::string& name_space) : handle_(name_space), spinner_(2, &queue_) {
    handle_.setCallbackQueue(&queue_);
    pause_ = handle_.advertiseService("pause", &Services::pause, this);
    step_ = handle_.advertiseService("step", &Services::step, this);
    reset_ = handle_.advertiseService("reset", &Services::reset, this);
    spinner_.start();
  }
  ~Services() { released = true; }

  std::atomic<double> takes{0};  // seconds that pause needs
  std::atomic<bool> released{false};
  std::atomic<bool> keep_time{false};

 private:
  ros::NodeHandle handle_;
  ros::CallbackQueue queue_;
  ros::AsyncSpinner spinner_;
  ros::ServiceServer pause_, step_, reset_;

  bool pause(std_srvs::SetBool::Request& request, std_srvs::SetBool::Response& response) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(takes.load());
    while (!released && std::chrono::steady_clock::now() < end)
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    response.success = true;
    response.message = request.data ? "Paused at 1 s." : "Goes on.";
    return true;
  }
  bool step(vibe_msgs::Step::Request& request, vibe_msgs::Step::Response& response) {
    response.success = false;
    response.message = "Not paused, so " + std::to_string(request.n) + " steps were not taken.";
    return true;
  }
  bool reset(vibe_msgs::Reset::Request& request, vibe_msgs::Reset::Response& response) {
    keep_time = request.keep_time;
    response.success = true;
    response.message = "Reset.";
    return true;
  }
};

struct ProcedureWidgetTest : testing::Test {
  std::unique_ptr<ProcedureWidget> widget;

  void open(const QString& name_space) {
    offscreenApplication();
    widget = std::make_unique<ProcedureWidget>();
    widget->setNamespace(name_space);
    widget->resize(320, 600);
    widget->show();
    widget->start();
  }
  std::string answer() const { return textOf(*widget, "answer"); }
  bool answers(double seconds, const std::string& part) {
    return waitFor(seconds, [&] { return contains(answer(), part); });
  }
};

TEST_F(ProcedureWidgetTest, ServicesAnswer) {
  Services services("/fast");
  open("/fast");
  click(*widget, "Pause");
  EXPECT_TRUE(answers(5, "Paused at 1 s.")) << answer();
  click(*widget, "Step");
  EXPECT_TRUE(answers(5, "Failed: Not paused, so 1 steps")) << answer();
  click(*widget, "Reset");
  click(*widget, "Sure?");
  EXPECT_TRUE(answers(5, "Reset.")) << answer();
  EXPECT_TRUE(services.keep_time);
}

TEST_F(ProcedureWidgetTest, MissingServiceIsNamed) {
  open("/nowhere");
  click(*widget, "Pause");
  EXPECT_TRUE(answers(5, "There is no service /nowhere/pause")) << answer();
}

TEST_F(ProcedureWidgetTest, SlowServiceDoesNotBlockThePanel) {
  Services services("/slow");
  services.takes = 5;
  open("/slow");
  QElapsedTimer since_tick;
  qint64 longest = 0;
  QTimer ticker;
  QObject::connect(&ticker, &QTimer::timeout, [&] { longest = std::max(longest, since_tick.restart()); });
  since_tick.start();
  ticker.start(10);
  QElapsedTimer whole;
  whole.start();
  click(*widget, "Pause");
  EXPECT_LT(whole.elapsed(), 500) << "pressing takes as long as the service";
  EXPECT_TRUE(answers(3, "no answer for 2 s")) << answer();
  EXPECT_TRUE(answers(10, "Paused at 1 s.")) << answer();
  EXPECT_GT(whole.elapsed(), 4500);
  EXPECT_LT(longest, 1500) << "the widgets stood still [ms]";
}

TEST_F(ProcedureWidgetTest, CallCanBeAbandoned) {
  Services services("/hangs");
  services.takes = 30;
  open("/hangs");
  click(*widget, "Pause");
  EXPECT_TRUE(answers(4, "no answer"));
  QElapsedTimer timer;
  timer.start();
  click(*widget, "Stop waiting");
  EXPECT_TRUE(answers(3, "given up")) << answer();
  services.takes = 0;
  click(*widget, "Pause");
  EXPECT_TRUE(answers(5, "Paused")) << answer();
  EXPECT_LT(timer.elapsed(), 10000);
}

TEST_F(ProcedureWidgetTest, ClosesDuringACall) {
  Services services("/closes");
  services.takes = 30;
  open("/closes");
  click(*widget, "Pause");
  waitFor(0.3, [] { return false; });
  QElapsedTimer timer;
  timer.start();
  widget.reset();
  EXPECT_LT(timer.elapsed(), 3000);
}

TEST_F(ProcedureWidgetTest, ButtonsBecomeMessages) {
  std::vector<sensor_msgs::Joy> heard;
  ros::NodeHandle handle("/quiet");
  const ros::Subscriber subscriber = handle.subscribe<sensor_msgs::Joy>(
      "scope/buttons", 1000, [&](const sensor_msgs::JoyConstPtr& message) { heard.push_back(*message); });
  const auto pressed = [&](const std::vector<int>& buttons) {
    return waitFor(3, [&] { return !heard.empty() && heard.back().buttons == buttons; });
  };
  open("/quiet");
  waitFor(0.5, [] { return false; });
  EXPECT_TRUE(heard.empty()) << "nobody took control";
  EXPECT_EQ(subscriber.getNumPublishers(), 0u);
  EXPECT_FALSE(widget->findChild<QPushButton*>("control")->isEnabled()) << "there is no simulator";
  ASSERT_TRUE(mayTakeControl(*widget, "/quiet", 20));
  click(*widget, "Take control");
  EXPECT_TRUE(pressed({0, 0, 0, 0, 0, 0}));
  click(*widget, "Helix grab");
  EXPECT_TRUE(pressed({0, 1, 0, 0, 0, 0}));
  auto* pedal = widget->findChild<QPushButton*>("APC pedal");
  pedal->setDown(true);
  Q_EMIT pedal->pressed();
  EXPECT_TRUE(pressed({1, 1, 0, 0, 0, 0}));
  Q_EMIT pedal->released();
  EXPECT_TRUE(pressed({0, 1, 0, 0, 0, 0}));
  EXPECT_FALSE(heard.back().header.stamp.isZero());
  const std::size_t before = heard.size();
  waitFor(1, [] { return false; });
  EXPECT_NEAR(static_cast<double>(heard.size() - before), 10, 5);
  click(*widget, "Give control back");
  EXPECT_TRUE(pressed({0, 1, 0, 0, 0, 0})) << "giving control back must not let the tissue go";
  EXPECT_TRUE(waitFor(3, [&] { return subscriber.getNumPublishers() == 0; }));
}

TEST_F(ProcedureWidgetTest, HeldButtonsStayHeld) {
  ros::NodeHandle handle("/held");
  std::vector<std::vector<int>> heard;
  const ros::Subscriber subscriber = handle.subscribe<sensor_msgs::Joy>(
      "scope/buttons", 1000, [&](const sensor_msgs::JoyConstPtr& message) { heard.push_back(message->buttons); });
  ros::Publisher applied = handle.advertise<vibe_msgs::StepInput>("applied_input", 10);
  open("/held");
  waitFor(0.3, [] { return false; });
  EXPECT_EQ(applied.getNumSubscribers(), 0u) << "a simulator that waits for its recorder would take the panel for it";
  ASSERT_TRUE(mayTakeControl(*widget, "/held", 20));
  click(*widget, "Take control");
  vibe_msgs::StepInput input;
  input.buttons = {1, 1, 0, 0, 0, 1};
  EXPECT_TRUE(waitFor(5, [&] {
    applied.publish(input);
    return !heard.empty();
  }));
  ASSERT_FALSE(heard.empty());
  EXPECT_EQ(heard.front(), (std::vector<int>{0, 1, 0, 0, 0, 1})) << "the pedal is under nobody's foot now";
  EXPECT_TRUE(waitFor(2, [&] { return applied.getNumSubscribers() == 0; }));
}

TEST_F(ProcedureWidgetTest, OtherPublisherInControlIsRespected) {
  open("/busy");
  const auto sentence = [&] { return textOf(*widget, "control sentence"); };
  ASSERT_TRUE(waitFor(10, [&] { return contains(sentence(), "/busy/rival has control"); })) << sentence();
  EXPECT_FALSE(mayTakeControl(*widget, "/busy", 1));
  EXPECT_FALSE(widget->findChild<QPushButton*>("Needle")->isEnabled());
}

TEST_F(ProcedureWidgetTest, SaysWhetherTheSimulatorIsRunning) {
  open("/lonely");
  const auto status = [&] { return textOf(*widget, "status"); };
  EXPECT_TRUE(waitFor(2, [&] { return contains(status(), "Waiting for the simulator on /lonely/procedure/state"); }))
      << status();
  ros::Publisher publisher = ros::NodeHandle("/lonely").advertise<vibe_msgs::ProcedureState>("procedure/state", 1);
  vibe_msgs::ProcedureState state;
  state.scene = "stomach";
  EXPECT_TRUE(waitFor(5, [&] {
    publisher.publish(state);
    return status().empty();
  })) << status();
  EXPECT_TRUE(contains(textOf(*widget, "header"), "stomach"));
  EXPECT_TRUE(waitFor(6, [&] { return contains(status(), "gone"); })) << status();
}

TEST_F(ProcedureWidgetTest, InvalidNamespaceIsRejected) {
  open("/good");
  widget->setNamespace("not good");
  EXPECT_EQ(widget->nameSpace(), "/good");
  waitFor(0.3, [] { return false; });
  EXPECT_TRUE(contains(textOf(*widget, "status"), "'not good' cannot be used"));
}

TEST_F(ProcedureWidgetTest, NamespaceIsSavedInTheConfiguration) {
  offscreenApplication();
  ProcedurePanel panel;
  rviz::Config config;
  config.mapSetValue("Namespace", "/room1");
  panel.load(config);
  const rviz::Config saved;
  panel.save(saved);
  QString name;
  EXPECT_TRUE(saved.mapGetString("Namespace", &name));
  EXPECT_EQ(name.toStdString(), "/room1");
}

}  // namespace
}  // namespace vibe::rviz_plugins

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "procedure_widget_test");
  ros::NodeHandle handle;  // keeps the node up
  return RUN_ALL_TESTS();
}
