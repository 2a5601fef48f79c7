#include "events/event_table.hpp"

namespace vibe {

using Kind = Event::Kind;
using Detail = EventDetail;
using Reason = RejectReason;

const std::vector<EventRow>& eventRows() {
  static const std::vector<EventRow> rows = {
      {Kind::Grab, Detail::None, "grab", "", "The helix holds the {region}, {wall} wall."},
      {Kind::GrabMissed, Detail::None, "grab missed", "m",
       "The helix found no tissue: the nearest is {value:mm} from its tip, and it reaches {limit:mm}."},
      {Kind::Release, Detail::None, "release", "N", "The helix released the tissue at {value:N}."},
      {Kind::Slip, Detail::None, "slip", "N",
       "The tissue tore off the helix at {value:N}; after {amount:turns} the helix holds {limit:N}."},
      {Kind::ContactBegin, Detail::None, "contact begin", "", "The tool touches tissue."},
      {Kind::ContactEnd, Detail::None, "contact end", "", "The tool no longer touches tissue."},
      {Kind::PressureReached, Detail::None, "pressure reached", "Pa",
       "The insufflator has reached its set point at {value:mmHg}."},
      {Kind::Warning, Detail::None, "warning", "", "A warning; the log of the program has the reason."},
      {Kind::Recovery, Detail::NotFinite, "recovery", "",
       "Positions of the tissue were not finite, so the tissue was put back to rest; check masses and stiffness of the "
       "scene."},
      {Kind::Recovery, Detail::SpeedLimited, "recovery", "",
       "{value:particles} were slowed to keep the step stable; move the tool slower or raise tissue.substeps."},
      {Kind::Recovery, Detail::Distorted, "recovery", "",
       "The tissue was overstretched, turned inside out or tangled and is led back to rest; undo what caused it."},
      {Kind::Rejected, Detail::None, "rejected", "", ""},
      {Kind::Mark, Detail::InZone, "mark", "J",
       "A mark begins (wall {wall}, region {region}), {amount:marks} in total."},
      {Kind::Mark, Detail::OutOfZone, "mark", "J",
       "A mark begins (wall {wall}, region {region}, outside the working zone), {amount:marks} in total."},
      {Kind::Burn, Detail::None, "burn", "J",
       "The beam has stayed so long that a scar remains (wall {wall}, region {region}); a mark takes about a second."},
      {Kind::DeepBurn, Detail::None, "deep burn", "J",
       "The beam has stayed so long that the muscularis is at risk (wall {wall}, region {region}); go on elsewhere."},
      {Kind::HelixTurned, Detail::None, "helix turned", "turns", "The helix is {value:turns} in and holds {limit:N}."},
      {Kind::Bite, Detail::FullThickness, "bite", "m",
       "Bite {bite} of set {set}: full thickness, {value:mm} deep, {region}, {wall} wall{spacing}."},
      {Kind::Bite, Detail::PartialThickness, "bite", "m",
       "Bite {bite} of set {set}: partial thickness, {value:mm} deep, {region}, {wall} wall{spacing}."},
      {Kind::BiteMissed, Detail::None, "bite missed", "m",
       "The needle met no tissue: it missed the wall by {value:mm}; pull more tissue in with the helix."},
      {Kind::BiteWithdrawn, Detail::None, "bite withdrawn", "",
       "The needle was withdrawn from the wall without a bite: the anchor exchange did not have it yet."},
      {Kind::NeedleExchanged, Detail::NeedleOnArm, "needle exchanged", "", "The arm holds the needle."},
      {Kind::NeedleExchanged, Detail::NeedleInExchange, "needle exchanged", "",
       "The anchor exchange holds the needle."},
      {Kind::BleedingMild, Detail::None, "bleeding mild", "m^3/s",
       "Bite {bite} of set {set} bleeds mildly, {value:ml/min}."},
      {Kind::BleedingBrisk, Detail::None, "bleeding brisk", "m^3/s",
       "Bite {bite} of set {set} bleeds briskly, {value:ml/min}; complete and cinch the set."},
      {Kind::BleedingStopped, Detail::MildByItself, "bleeding stopped", "m^3",
       "A mild bleeding of set {set} stopped by itself after {value:ml}."},
      {Kind::BleedingStopped, Detail::MildCinched, "bleeding stopped", "m^3",
       "A mild bleeding of set {set} stopped under the cinch after {value:ml}."},
      {Kind::BleedingStopped, Detail::BriskCinched, "bleeding stopped", "m^3",
       "A brisk bleeding of set {set} stopped under the cinch after {value:ml}."},
      {Kind::BleedingOverdue, Detail::None, "bleeding overdue", "m^3",
       "The brisk bleeding of set {set} was not stopped in time, {value:ml} so far; complete and cinch the set."},
      {Kind::TechniqueFound, Detail::None, "technique found", "",
       "The bites of set {set} form the pattern '{technique}'."},
      {Kind::TTagDropped, Detail::None, "t-tag dropped", "", "The T-tag holds set {set} of {value:bites}."},
      {Kind::CinchPulling, Detail::None, "cinch pulling", "", "The cinch draws the thread of set {set}."},
      {Kind::Cinched, Detail::ThreadDrawn, "cinched", "N",
       "Set {set} is cinched at {value:N}, {amount:mm} of thread were drawn."},
      {Kind::Cinched, Detail::WallDrawn, "cinched", "N",
       "Set {set} is cinched at {value:N}, the wall was drawn by {amount:mm}."},
      {Kind::CinchLoose, Detail::ThreadDrawn, "cinch loose", "N",
       "Set {set} is cinched loosely at {value:N}, {amount:mm} of thread were drawn."},
      {Kind::CinchLoose, Detail::WallDrawn, "cinch loose", "N",
       "Set {set} is cinched loosely at {value:N}, the wall was drawn by {amount:mm}."},
      {Kind::TearOut, Detail::None, "tear-out", "N",
       "Bite {bite} of set {set} tore out at {value:N}, it held {limit:N}."},
      {Kind::ThreadBroke, Detail::None, "thread broke", "N",
       "The thread of set {set} broke at {value:N}, its strength is {limit:N}."},
      {Kind::PhaseChanged, Detail::None, "phase changed", "", "The phase is now '{phase}'."},
      {Kind::Pierced, Detail::None, "pierced", "m",
       "The needle is {value:mm} deep in the wall; hand it to the anchor exchange."},
      {Kind::ArmClosed, Detail::None, "arm closed", "",
       "The arm closed over the anchor exchange, which holds the needle and can hand it back."},
      {Kind::Blocked, Detail::None, "blocked", "N",
       "The wall ({region}, {wall}) lets the tool move no further, at {value:N}; go back the way it came, or release "
       "the helix."},
      {Kind::LeftLumen, Detail::None, "left lumen", "m",
       "The tip of the scope is outside of the organ, with {value:mm} of the scope in, beyond or beside an open end; "
       "draw it back."}};
  return rows;
}

const std::vector<ReasonRow>& reasonRows() {
  static const std::vector<ReasonRow> rows = {
      {Reason::None, "none", "The command could not act."},
      {Reason::NoGas, "no gas",
       "The button '{button}' has no effect: the scene has no section 'gas'; add `gas:` to it."},
      {Reason::NoScope, "no scope",
       "The button '{button}' has no effect: the scene has no section 'scope'; add `scope:` to it."},
      {Reason::NoMarking, "no marking",
       "The button '{button}' has no effect: the scene has no section 'marking'; add `marking:` to it."},
      {Reason::NoHelix, "no helix",
       "The button '{button}' has no effect: the scene has no section 'helix'; add `helix:` to it."},
      {Reason::NoSuture, "no suture",
       "The button '{button}' has no effect: the scene has no section 'suture'; add `suture:` to it."},
      {Reason::BeamOutOfReach, "beam out of reach",
       "The argon beam meets no tissue within {limit:mm} in front of the scope: go nearer."},
      {Reason::ClosedWithoutNeedle, "closed without needle",
       "The arm closed without a needle, which went with the T-tag: cinch the set to get a new one."},
      {Reason::NoNeedle, "no needle", "There is no needle, it went with the T-tag: cinch the set to get a new one."},
      {Reason::ArmOpen, "arm open",
       "The arm is open and meets the anchor exchange only when it is closed: close it first."},
      {Reason::ArmStillInBite, "arm still in bite",
       "The arm is still in the last bite: open it and close it again before it takes the needle back."},
      {Reason::TooManySets, "too many sets",
       "A session has at most {limit:sets}, and all are used: reset to start again."},
      {Reason::SetFull, "set full",
       "The set already has {limit:bites}, as many as it may: open the arm to withdraw the needle, then drop the "
       "T-tag."},
      {Reason::ThreadUsedUp, "thread used up",
       "The thread is used up, {limit:mm} are left and this bite needs {amount:mm}: open the arm to withdraw the "
       "needle, "
       "then drop the T-tag."},
      {Reason::TTagDropped, "t-tag dropped already",
       "The T-tag of this set is dropped already: hold the cinch until the set is tight, then release it."},
      {Reason::NoBite, "no bite", "There is no bite that a T-tag could hold: take bites first."},
      {Reason::NeedleInWall, "needle in wall",
       "The needle is in the wall: hand it to the anchor exchange, or open the arm, before dropping the T-tag."},
      {Reason::TooFewBites, "too few bites",
       "The set has only {amount:bites} and needs {limit:bites}: take more before dropping the T-tag."},
      {Reason::NoThread, "no thread", "There is no thread to cinch: take bites and drop the T-tag first."},
      {Reason::NoTTag, "no t-tag", "The thread is not held at its end yet: drop the T-tag before the cinch."}};
  return rows;
}

}  // namespace vibe
