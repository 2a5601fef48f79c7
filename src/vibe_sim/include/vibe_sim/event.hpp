#pragma once
#include <cstdint>
#include <string>

namespace vibe {

/// Something that happened in a step. The kinds' numbers go on the wire (vibe_msgs/ProcedureEvent).
struct Event {
  enum class Kind : std::uint8_t {
    Grab = 0,          ///< the helix took hold; particle: the targeted one, value: particles held
    GrabMissed = 1,    ///< pressed, but no tissue in reach; value: distance to the nearest particle [m]
    Release = 2,       ///< let go on command; value: force just before [N]
    Slip = 3,          ///< torn off above the hold force; value: force [N]
    ContactBegin = 4,  ///< the tool touches tissue; value: particles touched
    ContactEnd = 5,
    PressureReached = 6,  ///< the insufflator has reached its set point; value: gauge pressure [Pa]
    Warning = 7,          ///< text says what and what to do
    Recovery = 8          ///< the solver met a state it could not continue from and recovered; text says how
  };
  Kind kind = Kind::Warning;
  double time = 0;    ///< simulated time of the step's end [s]
  int particle = -1;  ///< -1: none
  double value = 0;
  std::string text;  ///< one sentence for people
};

const char* toString(Event::Kind kind);

}  // namespace vibe
