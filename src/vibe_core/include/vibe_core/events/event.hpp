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
    Recovery = 8,         ///< the solver met a state it could not continue from and recovered; text says how
    Refused = 9,          ///< a command could not act; text gives the one reason and what to do; value: Button or -1
    Mark = 10,      ///< a mark begins, apart from all others; particle: where, value: dose there [J]. Said once: a mark
                    ///< that grows, as a line does that is drawn, says no more. So do burns:
    Burn = 11,      ///< a burn scar begins; value: dose there [J]
    DeepBurn = 12,  ///< the muscularis begins to be at risk; value: dose there [J]
    HelixTurned = 13,      ///< the helix is in as far as it holds best; value: turns
    Bite = 14,             ///< the exchange took the needle: a bite; particle: nearest, value: depth [m]
    BiteMissed = 15,       ///< the arm closed and met no tissue; value: gap between needle and mucosa [m]
    BiteWithdrawn = 16,    ///< the arm opened before the exchange had the needle: no bite
    NeedleExchanged = 17,  ///< value: 1: the arm holds the needle again, 0: the exchange holds it
    BleedingMild = 18,     ///< value: rate [m^3/s]
    BleedingBrisk = 19,    ///< complete the suture; value: rate [m^3/s]
    BleedingStopped = 20,  ///< value: amount lost there [m^3]
    BleedingOverdue = 21,  ///< brisk bleeding was not stopped in time; value: amount so far [m^3]
    TechniqueFound = 22,   ///< at the T-tag; value: Technique, text names it
    TTagDropped = 23,      ///< value: bites of the set
    CinchPulling = 24,     ///< the cinch begins to draw thread
    Cinched = 25,          ///< the set is permanent; value: tension [N]
    CinchLoose = 26,       ///< cinched, but slack; value: tension [N]
    TearOut = 27,          ///< a bite tore out of the wall; particle: nearest, value: force on it [N]
    ThreadBroke = 28,      ///< value: tension [N]
    PhaseChanged = 29,     ///< value: Phase, text names it
    Pierced = 30,          ///< the arm closed and the needle went into the wall; value: depth below the mucosa [m]
    ArmClosed = 31         ///< the arm closed without a needle, over the exchange that holds it
  };
  Kind kind = Kind::Warning;
  double time = 0;    ///< simulated time of the step's end [s]
  int particle = -1;  ///< -1: none
  double value = 0;
  std::string text;  ///< one sentence for people
};

const char* toString(Event::Kind kind);

}  // namespace vibe
