#include "vibe_core/solver/step_ways.hpp"

namespace vibe {

const char* nameOf(StepWay way) {
  switch (way) {
    case StepWay::Asleep:
      return "asleep";
    case StepWay::Recovery:
      return "recovery";
    case StepWay::GuessTangled:
      return "guess tangled";
    case StepWay::GuessMisled:
      return "guess misled";
    case StepWay::ContactsExchanged:
      return "contacts exchanged";
    case StepWay::ToolReaimedEarly:
      return "tool reaimed early";
    case StepWay::PairsDropped:
      return "pairs dropped";
    case StepWay::SearchRestarted:
      return "search restarted";
    case StepWay::ConstraintsMet:
      return "constraints met";
    case StepWay::LastMoveUnseen:
      return "last move unseen";
    case StepWay::NotArrived:
      return "not arrived";
    case StepWay::BackwardEuler:
      return "backward Euler";
    case StepWay::ToolReaimed:
      return "tool reaimed";
    case StepWay::ToolLimited:
      return "tool limited";
    case StepWay::WallStopped:
      return "wall stopped";
    case StepWay::NotFinite:
      return "not finite";
  }
  return "";
}

}  // namespace vibe
