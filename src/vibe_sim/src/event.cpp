#include "vibe_sim/event.hpp"

namespace vibe {

const char* toString(Event::Kind kind) {
  switch (kind) {
    case Event::Kind::Grab:
      return "grab";
    case Event::Kind::GrabMissed:
      return "grab missed";
    case Event::Kind::Release:
      return "release";
    case Event::Kind::Slip:
      return "slip";
    case Event::Kind::ContactBegin:
      return "contact begin";
    case Event::Kind::ContactEnd:
      return "contact end";
    case Event::Kind::PressureReached:
      return "pressure reached";
    case Event::Kind::Warning:
      return "warning";
    case Event::Kind::Recovery:
      return "recovery";
  }
  return "unknown";
}

}  // namespace vibe
