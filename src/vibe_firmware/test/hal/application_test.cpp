#include "vibe_firmware/hal/application.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <deque>
#include <vector>

#include "vibe_firmware/protocol/haptic_function.hpp"
#include "vibe_firmware/protocol/input_function.hpp"

namespace vibe_firmware::application_test {
namespace {

class FakeBoard : public Board {
 public:
  HapticSample sample() override {
    HapticSample sample;
    sample.counter = {static_cast<std::uint32_t>(count_), 0};
    sample.time_us = time_us_ += period_us_;
    return sample;
  }
  void writeTorque(const std::array<float, kAxisCount>& torque) override { torques_.push_back(torque); }
  void feedWatchdog() override { ++fed_; }

  std::int32_t count_ = 0;
  std::uint32_t period_us_ = 1000;
  std::uint32_t time_us_ = 0;
  std::vector<std::array<float, kAxisCount>> torques_;
  int fed_ = 0;
};

struct Request {
  UsbSetup setup;
  std::vector<std::uint8_t> data;
};

class FakeLink : public UsbLink {
 public:
  void poll(ControlHandler& handler) override {
    if (reset_) handler.handleBusReset();
    reset_ = false;
    if (suspend_) handler.handleSuspend();
    suspend_ = false;
    while (!requests_.empty()) {
      std::uint8_t response[ControlHandler::kMaxData];
      result_ = handler.handleControl(requests_.front().setup, requests_.front().data.data(), response);
      response_.assign(response, response + (result_ > 0 ? result_ : 0));
      requests_.pop_front();
    }
  }
  bool sendReport(const std::uint8_t* bytes, std::size_t size) override {
    reports_.emplace_back(bytes, bytes + size);
    return true;
  }

  void configure() { requests_.push_back({{0x00, 9, 1, 0, 0}, {}}); }

  std::deque<Request> requests_;
  bool reset_ = false;
  bool suspend_ = false;
  int result_ = 0;
  std::vector<std::uint8_t> response_;
  std::vector<std::vector<std::uint8_t>> reports_;
};

struct Haptic : testing::Test {
  void run(int ticks) {
    for (int i = 0; i < ticks; ++i) {
      application_.tick();
      application_.poll();
    }
  }

  void sendSpring(float stiffness) {
    ParameterReport parameters;
    parameters.number = 7;
    for (AxisParameters& axis : parameters.axes) {
      axis.stiffness = stiffness;
      axis.torque_limit = 0.02F;
    }
    std::uint8_t bytes[kParameterReportSize];
    pack(parameters, bytes);
    link_.requests_.push_back({{0x21, 9, 0x0302, 0, sizeof bytes}, {bytes, bytes + sizeof bytes}});
  }

  FakeBoard board_;
  FakeLink link_;
  HapticFunction function_{HapticConfig{}};
  Application<HapticFunction> application_{board_, link_, function_};
};

TEST_F(Haptic, WritesTheTorqueOfEachTick) {
  sendSpring(0.1F);
  run(2);
  board_.count_ = 10;
  run(100);
  ASSERT_EQ(board_.torques_.size(), 102U);
  EXPECT_NEAR(board_.torques_.back()[0], -0.1F * 10 * AxisConfig{}.radians_per_count, 1e-7F);
  EXPECT_EQ(board_.torques_.back()[1], 0);
}

TEST_F(Haptic, SendsAReportEveryTenTicksOnceItIsConfigured) {
  run(50);
  EXPECT_TRUE(link_.reports_.empty());
  link_.configure();
  run(100);
  EXPECT_EQ(link_.reports_.size(), 10U);
  InputReport first, second;
  ASSERT_TRUE(unpack(link_.reports_[3].data(), link_.reports_[3].size(), first));
  ASSERT_TRUE(unpack(link_.reports_[4].data(), link_.reports_[4].size(), second));
  EXPECT_EQ(second.sequence, first.sequence + 1);
  EXPECT_EQ(second.time_us, first.time_us + 10000);
}

TEST_F(Haptic, SendsNothingAfterABusReset) {
  link_.configure();
  run(20);
  const std::size_t before = link_.reports_.size();
  link_.reset_ = true;
  run(50);
  EXPECT_EQ(link_.reports_.size(), before);
}

TEST_F(Haptic, TheSpringFadesAtOnceWhenTheHostSleepsOrLeaves) {
  for (bool* event : {&link_.suspend_, &link_.reset_}) {
    sendSpring(0.1F);
    run(2);
    board_.count_ = 10;
    run(100);
    const float held = board_.torques_.back()[0];
    ASSERT_LT(held, -1e-5F);
    *event = true;
    run(25);
    EXPECT_NEAR(board_.torques_.back()[0], held / 2, 0.05F * std::fabs(held));
    run(30);
    EXPECT_EQ(board_.torques_.back()[0], 0);
    sendSpring(0.1F);
    run(50);
    EXPECT_NEAR(board_.torques_.back()[0], held, 1e-7F) << "new parameters bring it back";
    board_.count_ = 0;
    run(50);
  }
}

TEST_F(Haptic, SendsNothingWhileTheEndpointIsHalted) {
  link_.configure();
  run(20);
  const std::size_t before = link_.reports_.size();
  link_.requests_.push_back({{0x02, 3, 0, 0x81, 0}, {}});  // SET_FEATURE, ENDPOINT_HALT
  run(50);
  EXPECT_EQ(link_.reports_.size(), before);
}

TEST_F(Haptic, FeedsTheWatchdogOnlyIfInterruptAndMainLoopRun) {
  run(5);
  EXPECT_EQ(board_.fed_, 5);
  for (int i = 0; i < 100; ++i) application_.poll();
  EXPECT_EQ(board_.fed_, 5);
  for (int i = 0; i < 100; ++i) application_.tick();
  EXPECT_EQ(board_.fed_, 5);
}

TEST_F(Haptic, CountsLateTicks) {
  run(10);
  board_.period_us_ = 1200;
  run(3);
  board_.period_us_ = 1000;
  run(10);
  link_.requests_.push_back({{0xA1, 1, 0x0303, 0, kStatusReportSize}, {}});
  run(1);
  StatusReport status;
  ASSERT_TRUE(unpack(link_.response_.data(), link_.response_.size(), status));
  EXPECT_EQ(status.late_ticks, 3U);
}

TEST_F(Haptic, LosesReportsThatTheMainLoopDoesNotFetch) {
  link_.configure();
  run(11);
  for (int i = 0; i < 30; ++i) application_.tick();
  run(10);
  std::vector<int> sequence;
  for (const std::vector<std::uint8_t>& bytes : link_.reports_) {
    InputReport report;
    ASSERT_TRUE(unpack(bytes.data(), bytes.size(), report));
    sequence.push_back(report.sequence);
  }
  EXPECT_EQ(sequence, (std::vector<int>{0, 1, 4, 5}));
}

TEST(InputApplication, WritesNoTorque) {
  FakeBoard board;
  FakeLink link;
  InputFunction function{InputConfig{}};
  Application<InputFunction> application(board, link, function);
  link.configure();
  for (int i = 0; i < 40; ++i) {
    application.tick();
    application.poll();
  }
  EXPECT_TRUE(board.torques_.empty());
  EXPECT_EQ(link.reports_.size(), 4U);
}

}  // namespace
}  // namespace vibe_firmware::application_test
