#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "vibe_core/geometry/organ.hpp"
#include "vibe_core/suture/technique.hpp"
#include "vibe_core/trainee/skill.hpp"

namespace vibe {

/// A place on the wall of the organ in its present shape: anatomical coordinates (see AnatomicalMap), then millimetres
/// along the wall from there.
struct Place {
  double along = 0.5;   ///< the axis, 0: apex of the fundus, 1: duodenal end; of `region`, if there is one
  double around = 0;    ///< angle from the greater curvature, positive towards the anterior wall [rad]
  double distal = 0;    ///< distance from there along the wall, towards the pylorus [m]
  double anterior = 0;  ///< and then around the organ, towards the front [m]
  std::optional<Region> region =
      std::nullopt;  ///< `along` is a share of it, see AnatomicalMap::alongIn(); empty: of the axis
};

struct InsufflateGoal {
  double patience = 30;  ///< time after which the goal is given up [s]
};

/// Looks at a place of the wall: from a distance, with the place in the middle of the endoscope's picture.
struct InspectGoal {
  Place place;              ///< at which it looks
  double distance = 40e-3;  ///< of the tip from the wall [m]
  double time = 1;          ///< that it stays there [s]
};

/// Looks everywhere: turns to what it has not seen since the first such goal was added, until enough is seen.
struct SurveyGoal {
  double coverage = 0.9;                        ///< share of the area of the wall to be seen, 0 to 1; see WallCoverage
  std::optional<Region> region = std::nullopt;  ///< of which it is a share; empty: of the whole wall
  double distance = 60e-3;                      ///< of the tip from where it looks; half of it in a second round [m]
  double patience = 180;                        ///< time after which the goal is given up [s]
};

struct MarkGoal {
  Place place;      ///< at which the beam is aimed
  double time = 2;  ///< that the pedal is pressed [s]
};

struct BiteGoal {
  Place place;  ///< where the needle is to go through the wall
};

/// Bites in a pattern around a place, each as far from the last as the lengths ask for.
struct SutureSetGoal {
  Technique pattern = Technique::U;  ///< shape of the set; not Technique::Other
  Place centre;                      ///< of the pattern
  int bites = 7;                     ///< number in all, fewestBites() of the pattern to kTechniqueMaxBites
  double length = 25e-3;             ///< of the pattern along the organ [m]
  double width = 60e-3;              ///< and around it [m]
  bool mirrored = false;             ///< begins on the posterior instead of the anterior side
  bool cinched = true;               ///< ends with T-tag and cinch
  double spacing = 0;                ///< of the sets of its row, as Place::along; leaves less `length`; 0: it is alone
};

struct CinchGoal {};

struct WithdrawGoal {
  double insertion = 0;  ///< [m]
};

struct WaitGoal {
  double time = 1;  ///< [s]
};

/// One thing that a trainee is to do.
using Goal = std::variant<InsufflateGoal, InspectGoal, SurveyGoal, MarkGoal, BiteGoal, SutureSetGoal, CinchGoal,
                          WithdrawGoal, WaitGoal>;

/// One line for people: "suture set u at 45 %, 0 deg".
std::string describe(const Goal& goal);

/// What became of a goal.
struct GoalResult {
  bool reached = false;  ///< false: given up
  std::string reason;    ///< one sentence, if not reached; what was done, if it was
  int bites_taken = 0;   ///< for it
};

/// What a trainee that looks is to do, and how well. docs/protocols.md describes the format.
struct Protocol {
  std::string name;         ///< for people
  Skill skill;              ///< of the trainee; an expert where the file says nothing
  std::uint64_t seed = 1;   ///< of aim errors and tremor
  std::vector<Goal> goals;  ///< in their order; at least one if it was read

  /// @throws Error with file, line and remedy for input that does not follow the format
  static Protocol load(const std::string& file);
  /// Reads a text instead of a file, with the same errors.
  /// @param place  what to call it in errors, e.g. the name of its file
  static Protocol parse(const std::string& yaml, const std::string& place);
};

/// Whether a file is a protocol, that is, has a key `goals`, rather than a trainee script.
/// @throws Error if it cannot be read
bool isProtocol(const std::string& file);

}  // namespace vibe
