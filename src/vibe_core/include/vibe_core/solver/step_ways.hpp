#pragma once

#include <array>
#include <cstddef>

namespace vibe {

/// The ways on which a step goes on where something is not as foreseen, in the order in which a step may meet them.
/// docs/computation.md says of each when it is taken, how often, and what would follow without it.
enum class StepWay {
  Asleep,             ///< the tissue rests and nothing new acts: the step is skipped
  Recovery,           ///< tissue that was lost or jammed is led towards rest, without a solve
  GuessTangled,       ///< the extrapolated positions have far more energy: the solve starts from the present ones
  GuessMisled,        ///< the first direction leads back from the extrapolated positions: the same
  ContactsExchanged,  ///< contacts without a row would be deep in the tool: they take the rows of idle ones
  ToolReaimedEarly,   ///< the first direction leads the tool elsewhere: contacts are found anew before anything moves
  PairsDropped,       ///< a direction with the history leads up: the history goes
  SearchRestarted,    ///< no part of a direction lowers the energy: once more without the history
  ConstraintsMet,     ///< constraints that are still violated are met at once, whatever that costs in energy
  LastMoveUnseen,     ///< the last move is not evaluated, because what it leaves is foreseen to be small
  NotArrived,         ///< the work of the step is used up: it ends at the best point, with the mean velocity
  BackwardEuler,      ///< one of the last steps did not arrive: backward Euler takes the place of the scheme
  ToolReaimed,        ///< the solve leads the tool elsewhere: contacts are found anew and the step is solved again
  ToolLimited,        ///< the tool does not come to where the solve has it: solved again with the tool where it can go
  WallStopped,        ///< then the wall would run into the tool: all of it stops on its way
  NotFinite,          ///< numbers that are not finite: the simulator starts again from rest
};

constexpr std::size_t kStepWayCount = 16;  ///< of StepWay

/// How often a step has taken each way.
class StepWays {
 public:
  /// Once more.
  void count(StepWay way) { ++taken_[static_cast<std::size_t>(way)]; }
  /// Times that it was taken.
  int of(StepWay way) const { return taken_[static_cast<std::size_t>(way)]; }
  /// Those of a solve to those of its step.
  void add(const StepWays& others) {
    for (std::size_t k = 0; k < kStepWayCount; ++k) taken_[k] += others.taken_[k];
  }

 private:
  std::array<int, kStepWayCount> taken_{};
};

/// A word for tables, such as "guess tangled".
const char* nameOf(StepWay way);

}  // namespace vibe
