#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <type_traits>
#include <vector>

#include "vibe_core/geometry/organ.hpp"

namespace vibe {

/// Why a command could not act. describe() gives the sentence with the remedy.
enum class RejectReason : std::uint8_t {
  None,
  NoGas,           ///< the scene has no section of this name; so do the next four
  NoScope,         ///< as above
  NoMarking,       ///< as above
  NoHelix,         ///< as above
  NoSuture,        ///< as above
  BeamOutOfReach,  ///< no tissue in front of the scope; limit: how far from its tip the beam goes [m]
  ClosedWithoutNeedle,
  NoNeedle,  ///< the needle went with the T-tag
  ArmOpen,
  ArmStillInBite,
  TooManySets,   ///< limit: sets of a session
  SetFull,       ///< limit: bites of a set
  ThreadUsedUp,  ///< amount: what the bite needs, limit: what is left [m]
  TTagDropped,   ///< already, for this set
  NoBite,
  NeedleInWall,
  TooFewBites,  ///< amount: bites of the set, limit: what it needs
  NoThread,     ///< to cinch
  NoTTag
};
constexpr int kRejectReasonCount = 20;  ///< values of RejectReason, None included

/// Which of the things that share a kind has happened.
enum class EventDetail : std::uint8_t {
  None,
  NotFinite,         ///< Recovery: positions were not finite; the tissue starts again from rest
  SpeedLimited,      ///< Recovery: value: particles that were slowed
  Distorted,         ///< Recovery: overstretched, inverted or tangled tissue is led back to rest
  InZone,            ///< Mark: in the working zone, see inWorkingZone()
  OutOfZone,         ///< Mark: outside of it
  FullThickness,     ///< Bite: through the whole wall
  PartialThickness,  ///< Bite: not through
  NeedleOnArm,       ///< NeedleExchanged
  NeedleInExchange,  ///< NeedleExchanged
  MildByItself,      ///< BleedingStopped
  MildCinched,       ///< BleedingStopped: by the cinch of its set
  BriskCinched,      ///< BleedingStopped: by the cinch of its set
  ThreadDrawn,       ///< Cinched, CinchLoose: amount: thread drawn by the cinch [m]
  WallDrawn          ///< Cinched, CinchLoose: amount: way of the wall (suture.cinch_model: groups) [m]
};
constexpr int kEventDetailCount = 15;  ///< values of EventDetail, None included

/// Something that happened in a step, as plain numbers; describe() makes a sentence of it. The numbers of the kinds are
/// those of vibe_msgs/ProcedureEvent.
struct Event {
  /// What has happened, and which members say more about it. region and wall are those of the particle.
  enum class Kind : std::uint8_t {
    Grab = 0,          ///< the helix took hold; particle: the targeted one, value: particles held; region, wall
    GrabMissed = 1,    ///< no tissue in reach; value: distance to the nearest particle, limit: reach of the helix [m]
    Release = 2,       ///< the helix let go on command; value: force just before [N]
    Slip = 3,          ///< the tissue tore off; value: force, limit: what the helix holds [N]; amount: turns
    ContactBegin = 4,  ///< the tool touches tissue; value: points of contact
    ContactEnd = 5,
    PressureReached = 6,   ///< the insufflator has reached its set point; value: gauge pressure [Pa]
    Warning = 7,           ///< of a program about its inputs, which brings its own sentence; never from a step
    Recovery = 8,          ///< the solver met a state from which it could not continue; detail: how it recovered
    Rejected = 9,          ///< a command could not act; reason: why; value: Button, or -1: the needle arm
    Mark = 10,             ///< a mark begins; particle: where, value: dose there [J], amount: marks; region, wall. A
                           ///< mark that grows, such as a line that is drawn, causes no further event; so do burns:
    Burn = 11,             ///< a burn scar begins; value: dose there [J]; region, wall
    DeepBurn = 12,         ///< the muscularis begins to be at risk; value: dose there [J]; region, wall
    HelixTurned = 13,      ///< the helix holds as well as it can; value: turns, limit: what it holds [N]
    Bite = 14,             ///< the exchange took the needle; particle: nearest, value: depth [m], amount: distance from
                           ///< the bite before [m]; suture, bite, region, wall
    BiteMissed = 15,       ///< the arm closed and met no tissue; value: gap between needle and mucosa [m]
    BiteWithdrawn = 16,    ///< the arm opened before the exchange had the needle: no bite
    NeedleExchanged = 17,  ///< value: 1: the arm holds the needle again, 0: the exchange holds it
    BleedingMild = 18,     ///< value: rate [m^3/s]; suture, bite
    BleedingBrisk = 19,    ///< complete the suture; value: rate [m^3/s]; suture, bite
    BleedingStopped = 20,  ///< value: amount lost there [m^3]; suture
    BleedingOverdue = 21,  ///< brisk bleeding was not stopped in time; value: amount so far [m^3]; suture
    TechniqueFound = 22,   ///< at the T-tag; value: Technique; suture
    TTagDropped = 23,      ///< value: bites of the set; suture
    CinchPulling = 24,     ///< the cinch begins to draw thread; suture
    Cinched = 25,          ///< the set is permanent; value: tension [N]; suture
    CinchLoose = 26,       ///< cinched, but slack; value: tension [N]; suture
    TearOut = 27,       ///< a bite tore out; particle: nearest, value: force on it, limit: its hold [N]; suture, bite
    ThreadBroke = 28,   ///< value: tension, limit: strength of the thread [N]; suture
    PhaseChanged = 29,  ///< value: Phase
    Pierced = 30,       ///< the arm closed and the needle went into the wall; value: depth below the mucosa [m]
    ArmClosed = 31,     ///< the arm closed without a needle, over the exchange that holds it
    Blocked = 32,   ///< the wall lets no joint move on; particle: nearest to what stops it, value: force on the tool
                    ///< [N]; region, wall
    LeftLumen = 33  ///< the tip is outside of the organ, which it has left by an end; value: insertion [m]
  };

  // Members that the kind does not name keep their defaults.
  Kind kind = Kind::Warning;                 ///< which of the other members have a meaning
  EventDetail detail = EventDetail::None;    ///< None: the kind has no variants
  RejectReason reason = RejectReason::None;  ///< of a rejected command; None: nothing was rejected
  Region region = Region::Body;              ///< where the particle is, of the kinds that name it
  Wall wall = Wall::Anterior;                ///< where the particle is, of the kinds that name it
  double time = 0;                           ///< simulated time at the end of the step [s]
  int particle = -1;                         ///< -1: none
  double value = 0;                          ///< see Kind; in unitOfValue(), or a number or code where there is no unit
  double limit = 0;            ///< what value or amount is compared with, see Kind and RejectReason [m], [N] or a ratio
  double amount = 0;           ///< a second number, see Kind, EventDetail and RejectReason [m] or a ratio
  int suture = -1, bite = -1;  ///< numbers from 0; -1: none
};
constexpr int kEventKindCount = 34;  ///< values of Event::Kind

static_assert(std::is_trivially_copyable_v<Event>, "an event carries facts; describe() forms the text");

/// Name of a kind: "grab", "bite missed". "unknown" outside of the enum.
const char* toString(Event::Kind kind);

/// Name of a reason: "no needle". "unknown" outside of the enum.
const char* toString(RejectReason reason);

/// Unit of Event::value: "m", "m^3", "m^3/s", "N", "Pa", "J" or "turns"; empty: a count, a code or nothing.
const char* unitOfValue(Event::Kind kind);

/// One sentence for people, with units; for a rejected command the reason and the remedy.
std::string describe(const Event& event);

struct State;

/// Where a step writes down what happens. An event gets the time that the state has when it is emitted: up to the solve
/// that of the start of the step, after it that of its end. A pair of references, to be passed by value.
class EventLog {
 public:
  /// @param state   whose clock counts; must outlive this, as `events` must
  /// @param events  are appended to
  EventLog(const State& state, std::vector<Event>& events) : state_(state), events_(events) {}

  /// Appends an event. The caller sets through the reference what else the kind carries, before the next event.
  Event& emit(Event::Kind kind, int particle = -1, double value = 0) const;

  /// Appends a rejection.
  /// @param command  Button, or -1: the closing of the needle arm
  Event& reject(int command, RejectReason reason) const;

 private:
  const State& state_;
  std::vector<Event>& events_;
};

/// How often each kind of event has happened. Whatever counts events reads this.
class EventCounts {
 public:
  /// @param events  of one step
  void record(const std::vector<Event>& events) {
    for (const Event& event : events) ++counts_[static_cast<std::size_t>(event.kind)];
  }

  /// How many events of a kind there were in all steps recorded.
  int of(Event::Kind kind) const { return counts_[static_cast<std::size_t>(kind)]; }

  /// Of all kinds.
  long total() const {
    long sum = 0;
    for (int count : counts_) sum += count;
    return sum;
  }

 private:
  std::array<int, kEventKindCount> counts_{};
};

}  // namespace vibe
