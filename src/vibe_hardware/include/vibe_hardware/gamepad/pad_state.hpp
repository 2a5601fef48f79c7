#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>

namespace vibe::hardware {

/// One event of an input device, as the kernel reports it.
struct PadEvent {
  double time = 0;  ///< [s], of any clock
  int type = 0;     ///< EV_ABS, EV_KEY, ...
  int code = 0;     ///< ABS_X, BTN_SOUTH, ...
  int value = 0;    ///< of an axis: its position; of a button: 1 down, 0 up, 2 repeated while down
};

/// An absolute axis: its range and its present value, in units of the device.
struct PadAxis {
  int minimum = -32768;  ///< left or up, or at rest for a trigger
  int maximum = 32767;   ///< right or down, or pulled for a trigger
  int value = 0;         ///< present position; may lie outside the range
  bool is_known = true;  ///< false: of a recording, before the first event of this axis; it rests

  /// From -1 at the minimum to 1 at the maximum; values beyond are limited. 0 for an axis without a range, or unknown.
  double deflection() const;
  /// From 0 at the minimum, where a trigger rests, to 1; 0 if it is unknown.
  double pressure() const;
};

/// A button. A button that was down when the pad was found counts as released until it is pressed again.
struct PadButton {
  bool down = false;          ///< as the device says, also if it has been since before the pad was found
  std::uint32_t presses = 0;  ///< since the pad was found; a press between two looks at the state is not lost

  bool isPressed() const { return down && presses > 0; }  ///< down, and pressed since the pad was found
};

/// State of all axes and buttons of a pad, by event code.
struct PadState {
  std::map<int, PadAxis> axes;       ///< by ABS_X, ...
  std::map<int, PadButton> buttons;  ///< by BTN_SOUTH, ...

  /// Takes an event over. Events of axes and buttons that the pad does not have are ignored.
  void apply(const PadEvent& event);
};

/// What a pad is: what the kernel says about it.
struct PadInfo {
  std::string name;           ///< "Microsoft X-Box 360 pad"
  std::string phys;           ///< "usb-0000:00:14.0-1/input0"; may be empty
  std::string path;           ///< "/dev/input/event5", or the file of a recording
  int bus = 0;                ///< BUS_USB, BUS_BLUETOOTH, ... of linux/input.h
  int vendor = 0;             ///< id of its maker on that bus
  int product = 0;            ///< id of the model
  int version = 0;            ///< of the model, as the device states it
  bool has_rumble = false;    ///< has a motor that shakes it (FF_RUMBLE)
  bool has_spring = false;    ///< has motors that move its stick (FF_SPRING)
  bool is_recording = false;  ///< the events come from a file
};

/// "ABS_X" for (EV_ABS, 0); the number for a code without a name.
std::string eventCodeName(int type, int code);
/// The inverse. @return -1 for a word that is no name of this type
int eventCodeFromName(int type, const std::string& name);

/// Where the events of a pad come from; what a test replaces.
class EventPort {
 public:
  /// What came of asking for the next event.
  enum class Status {
    Event,    ///< `event` is the next event
    Dropped,  ///< the kernel's queue has overflown and events are lost (SYN_DROPPED): go on with resync
    Empty,    ///< nothing waits; with resync: the state is up to date again
    Gone      ///< the device has been unplugged
  };
  virtual ~EventPort() = default;

  /// Never waits.
  /// @param resync  after Dropped: events that bring the state from before the loss to the present one
  virtual Status next(bool resync, PadEvent& event) = 0;
};

/// Keeps the state of a pad up to date from its events, also across lost ones.
class EventReader {
 public:
  /// @param initial  state of the pad when it was opened
  EventReader(EventPort& port, PadState initial) : port_(port), state_(std::move(initial)) {}

  /// Takes over everything that waits. @return false: the device is gone
  bool update();

  const PadState& state() const { return state_; }           ///< as of the last update()
  std::uint64_t eventCount() const { return event_count_; }  ///< events taken over so far
  std::uint64_t dropCount() const { return drop_count_; }    ///< times that the kernel's queue overflowed

  /// Called with every event, for a recording.
  void setListener(std::function<void(const PadEvent&)> listener) { listener_ = std::move(listener); }

 private:
  EventPort& port_;
  PadState state_;
  std::uint64_t event_count_ = 0;
  std::uint64_t drop_count_ = 0;
  std::function<void(const PadEvent&)> listener_;

  void take(const PadEvent& event);
};

}  // namespace vibe::hardware
