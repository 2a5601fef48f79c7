#include "vibe_core/events/event.hpp"

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
    case Event::Kind::Refused:
      return "refused";
    case Event::Kind::Mark:
      return "mark";
    case Event::Kind::Burn:
      return "burn";
    case Event::Kind::DeepBurn:
      return "deep burn";
    case Event::Kind::HelixTurned:
      return "helix turned";
    case Event::Kind::Bite:
      return "bite";
    case Event::Kind::BiteMissed:
      return "bite missed";
    case Event::Kind::BiteWithdrawn:
      return "bite withdrawn";
    case Event::Kind::NeedleExchanged:
      return "needle exchanged";
    case Event::Kind::BleedingMild:
      return "bleeding mild";
    case Event::Kind::BleedingBrisk:
      return "bleeding brisk";
    case Event::Kind::BleedingStopped:
      return "bleeding stopped";
    case Event::Kind::BleedingOverdue:
      return "bleeding overdue";
    case Event::Kind::TechniqueFound:
      return "technique found";
    case Event::Kind::TTagDropped:
      return "t-tag dropped";
    case Event::Kind::CinchPulling:
      return "cinch pulling";
    case Event::Kind::Cinched:
      return "cinched";
    case Event::Kind::CinchLoose:
      return "cinch loose";
    case Event::Kind::TearOut:
      return "tear-out";
    case Event::Kind::ThreadBroke:
      return "thread broke";
    case Event::Kind::PhaseChanged:
      return "phase changed";
    case Event::Kind::Pierced:
      return "pierced";
    case Event::Kind::ArmClosed:
      return "arm closed";
  }
  return "unknown";
}

}  // namespace vibe
