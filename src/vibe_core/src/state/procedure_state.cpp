#include "vibe_core/state/procedure_state.hpp"

namespace vibe {

const char* toString(Phase phase) {
  switch (phase) {
    case Phase::Inspect:
      return "inspect";
    case Phase::Mark:
      return "mark";
    case Phase::Suture:
      return "suture";
    case Phase::Pull:
      return "pull";
    case Phase::Done:
      return "done";
  }
  return "unknown";
}

}  // namespace vibe
