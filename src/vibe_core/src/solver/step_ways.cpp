#include "vibe_core/solver/step_ways.hpp"

namespace vibe {

const char* nameOf(StepWay way) {
  static constexpr std::array<const char*, kStepWayCount> kNames{
      "asleep",           "recovery",           "guess tangled",
      "guess misled",     "contacts exchanged", "tool reaimed early",
      "pairs dropped",    "search restarted",   "constraints met",
      "last move unseen", "not arrived",        "backward Euler",
      "tool reaimed",     "tool limited",       "wall stopped",
      "not finite"};
  return kNames[static_cast<std::size_t>(way)];
}

}  // namespace vibe
