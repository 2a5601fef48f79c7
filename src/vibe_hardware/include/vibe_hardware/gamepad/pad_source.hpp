#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "vibe_hardware/gamepad/pad_mapping.hpp"
#include "vibe_hardware/gamepad/pad_state.hpp"

namespace vibe::hardware {

/// Spring of one axis of a stick: force = coefficient (centre - deflection), as a share of the device's greatest.
struct StickSpring {
  double centre = 0;       ///< deflection without force, -1 to 1
  double coefficient = 0;  ///< 0 to 1; 1: the greatest force at a distance of one half of the axis
};

/// The motors of a pad.
class PadMotors {
 public:
  virtual ~PadMotors() = default;

  virtual bool hasRumble() const = 0;  ///< false: rumble() does nothing
  virtual bool hasSpring() const = 0;  ///< false: spring() does nothing
  /// @param strong, weak  of the heavy and the light motor, 0 to 1; ends by itself after half a second
  /// @return false if the device refuses it
  virtual bool rumble(double strong, double weak) = 0;
  /// @param springs  of ABS_X and ABS_Y; stays until the next call
  virtual bool spring(const std::array<StickSpring, 2>& springs) = 0;
};

/// A pad that is there: a device, or a recording of one.
class PadSource {
 public:
  virtual ~PadSource() = default;

  virtual const PadInfo& info() const = 0;  ///< what the pad says of itself; does not change
  /// Brings the state up to date. Never waits. @param now  steady time [s]. @return false: the pad is gone
  virtual bool update(double now) = 0;
  virtual const PadState& state() const = 0;  ///< as of the last update()
  /// null: it has none
  virtual PadMotors* motors() = 0;

  /// Events taken over so far, also those of axes that the pad does not have.
  virtual std::uint64_t eventCount() const = 0;
  virtual std::uint64_t dropCount() const = 0;  ///< times that events were lost and the state was read anew
  /// Called with every event, for a recording.
  virtual void setListener(std::function<void(const PadEvent&)> listener) = 0;
};

/// What has changed between a state and the axes (-1 to 1, left, up and a trigger at rest are 1, as joy_node has them)
/// and buttons of a sensor_msgs/Joy. Controls that the state does not have yet are added to it: axes at rest, and
/// unknown until their first value other than 0, because joy_node gives 0 for what has not moved yet. Values that are
/// not finite count as 0; numbers without a name are left out.
std::vector<PadEvent> joyEvents(const std::vector<float>& axes, const std::vector<int>& buttons, const JoyNames& names,
                                PadState& state);

/// Looks for a pad until there is one, and again when it is gone.
class PadLink {
 public:
  /// Opens a pad, or returns null and says why in one sentence.
  using Open = std::function<std::unique_ptr<PadSource>(std::string& why)>;
  explicit PadLink(Open open) : open_(std::move(open)) {}  ///< no pad yet; `open` has to be callable

  /// Brings the pad up to date, or looks for one, twice a second. Never waits.
  /// @param now  steady time [s]
  /// @return one sentence when something has changed, and the first time that no pad is found; else empty
  std::string poll(double now);

  /// null: there is none at present
  PadSource* pad() const { return pad_.get(); }
  std::uint64_t connections() const { return connections_; }  ///< times that a pad was found

 private:
  Open open_;
  std::unique_ptr<PadSource> pad_;
  double last_try_ = -1e9;  // [s]
  bool reported_ = false;   // that there is none
  std::uint64_t connections_ = 0;

  std::string look(double now);
};

/// An input device of this machine.
struct PadListing {
  PadInfo info;         ///< only its path if the device could not be opened
  PadState state;       ///< of the moment when it was listed; empty if it could not be opened
  bool is_pad = false;  ///< has two axes of a stick and a button of a gamepad or joystick
  std::string problem;  ///< why it could not be opened; empty: it could
};

/// All event devices in the order of their numbers.
/// @param folder  where the kernel puts them
std::vector<PadListing> listInputDevices(const std::string& folder = "/dev/input");

/// Opens a pad.
/// @param wanted  a path, or a part of the name or of the phys of a device; empty: the first pad that is not a
///                device of the scope
/// @param why     if none is opened: one sentence that says what was looked for, what was seen and what to do
/// @return null if there is none
std::unique_ptr<PadSource> openPad(const std::string& wanted, std::string& why,
                                   const std::string& folder = "/dev/input");

}  // namespace vibe::hardware
