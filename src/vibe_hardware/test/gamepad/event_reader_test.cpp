#include "vibe_hardware/gamepad/pad_state.hpp"

#include <gtest/gtest.h>

#include <deque>

#include "gamepad/pads.hpp"

namespace vibe::hardware::event_reader_test {
namespace {

/// A device whose queue overflows where the test says, and which can bring a reader up to date as libevdev does.
class ScriptedPort : public EventPort {
 public:
  std::deque<PadEvent> waiting;
  std::deque<PadEvent> resync_events;  // what libevdev finds to have changed
  bool overflown = false;
  bool gone = false;

  Status next(bool resync, PadEvent& event) override {
    if (gone) return Status::Gone;
    if (resync) return take(resync_events, event);
    if (overflown) {
      overflown = false;
      return Status::Dropped;
    }
    return take(waiting, event);
  }

 private:
  static Status take(std::deque<PadEvent>& queue, PadEvent& event) {
    if (queue.empty()) return Status::Empty;
    event = queue.front();
    queue.pop_front();
    return Status::Event;
  }
};

TEST(EventReader, TakesOverAllThatWaits) {
  ScriptedPort port;
  EventReader reader(port, twoStickPad());
  port.waiting = {{0, EV_ABS, ABS_X, 700}, {0, EV_KEY, BTN_SOUTH, 1}, {0, EV_SYN, SYN_REPORT, 0}};
  EXPECT_TRUE(reader.update());
  EXPECT_EQ(reader.state().axes.at(ABS_X).value, 700);
  EXPECT_TRUE(reader.state().buttons.at(BTN_SOUTH).isPressed());
  EXPECT_EQ(reader.eventCount(), 3u);
  EXPECT_EQ(reader.dropCount(), 0u);
}

TEST(EventReader, ReadsTheStateAnewAfterLostEvents) {
  ScriptedPort port;
  EventReader reader(port, twoStickPad());
  port.waiting = {{0, EV_KEY, BTN_SOUTH, 1}};
  reader.update();
  // the release and a motion are lost; the device knows the present state, and goes on afterwards
  port.overflown = true;
  port.resync_events = {{1, EV_KEY, BTN_SOUTH, 0}, {1, EV_ABS, ABS_Y, -900}, {1, EV_SYN, SYN_REPORT, 0}};
  port.waiting = {{2, EV_ABS, ABS_Y, -800}};
  EXPECT_TRUE(reader.update());
  EXPECT_FALSE(reader.state().buttons.at(BTN_SOUTH).down);
  EXPECT_EQ(reader.state().axes.at(ABS_Y).value, -800);
  EXPECT_EQ(reader.dropCount(), 1u);
}

TEST(EventReader, SaysThatTheDeviceIsGone) {
  ScriptedPort port;
  EventReader reader(port, twoStickPad());
  port.gone = true;
  EXPECT_FALSE(reader.update());
}

TEST(EventReader, DeviceThatFloodsDoesNotStopTheProgram) {
  class Flood : public EventPort {
   public:
    Status next(bool, PadEvent& event) override {
      event = {0, EV_ABS, ABS_X, 1};
      return Status::Event;
    }
  } port;
  EventReader reader(port, twoStickPad());
  EXPECT_TRUE(reader.update());
}

TEST(EventReader, DeviceThatNeverStopsLosingEventsDoesNotStopTheProgram) {
  class Broken : public EventPort {
   public:
    Status next(bool, PadEvent&) override { return Status::Dropped; }
  } port;
  EventReader reader(port, twoStickPad());
  EXPECT_TRUE(reader.update());
}

TEST(EventReader, EventsOfUnknownAxesAndButtonsAreIgnored) {
  ScriptedPort port;
  EventReader reader(port, twoStickPad());
  port.waiting = {{0, EV_ABS, ABS_MISC, 1}, {0, EV_KEY, KEY_A, 1}, {0, EV_REL, 0, 5}, {0, 99, -4, 5}};
  EXPECT_TRUE(reader.update());
  EXPECT_EQ(reader.state().axes.size(), twoStickPad().axes.size());
  EXPECT_EQ(reader.state().buttons.size(), twoStickPad().buttons.size());
}

}  // namespace
}  // namespace vibe::hardware::event_reader_test
