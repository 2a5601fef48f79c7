#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "vibe_core/geometry/organ.hpp"
#include "vibe_core/scene/scene.hpp"
#include "vibe_core/state/procedure_state.hpp"
#include "vibe_core/suture/technique.hpp"
#include "vibe_core/thermal/mark_zones.hpp"

namespace vibe {

/// Marks of a session. Connected particles with a grade are one zone, so a line is one.
struct MarkSkill {
  int zones = 0;                       ///< number of marks
  int inside = 0;                      ///< completely in the working zone, see inWorkingZone()
  std::array<int, kWallCount> wall{};  ///< by the Wall of the zone's worst particle
  int burns = 0;                       ///< zones with a burn scar or worse
  int deep_burns = 0;                  ///< zones where the muscularis is at risk
  double area = 0;                     ///< of all, of the rest shape [m^2]
};

/// Counts zones from the grades in the state. Takes some tens of microseconds and reuses its memory.
class MarkCounter {
 public:
  /// @param organ  must outlive this
  explicit MarkCounter(const Organ& organ);

  /// @param grades   BurnGrade by particle; with another size than the organ (a scene without marking): no zone
  /// @param x, y, z  positions of the particles [m]
  MarkSkill count(const std::vector<std::uint8_t>& grades, const std::vector<double>& x, const std::vector<double>& y,
                  const std::vector<double>& z);

 private:
  const Organ& organ_;
  ThermalDose law_;  // any parameters: grades map to doses and back
  MarkFinder finder_;
  std::vector<float> dose_;
};

/// The bites of a session. All members but `taken` and `torn_out` are about bites that hold. A measure that the bites
/// so far do not define has no value.
struct BiteSkill {
  int taken = 0;                               ///< including those that tore out
  int torn_out = 0;                            ///< of these
  int full_thickness = 0;                      ///< those through the whole wall, see Bite::fullThickness()
  std::array<int, kWallCount> wall{};          ///< by Wall
  int in_antrum = 0;                           ///< distal of the body: antrum, pylorus
  int in_fundus = 0;                           ///< proximal of the body: fundus, cardia
  std::optional<double> spacing_mean;          ///< between neighbours of a set, straight, in the rest shape [m]
  std::optional<double> spacing_sd;            ///< sample standard deviation [m]
  std::optional<double> depth_mean;            ///< below the mucosa [m]
  std::optional<double> depth_sd;              ///< sample standard deviation [m]
  std::optional<double> full_thickness_share;  ///< ratio
  std::optional<double> bites_proximal;        ///< share of steps from bite to bite of a set that go proximally
  std::optional<double> sets_proximal;         ///< the same from the middle of a set to that of the next (ratio)
};

/// One set of bites on one thread.
struct SetSkill {
  Suture::Stage stage = Suture::Stage::Open;  ///< of its suture, now
  bool loose = false;                         ///< cinched with less than the scene's loose_tension
  bool named = false;                         ///< technique and margin are known: the T-tag was dropped
  Technique technique = Technique::Other;     ///< that was recognised
  double margin = 0;                          ///< see TechniqueResult (ratio)
  int bites = 0;                              ///< that hold
  int torn_out = 0;                           ///< bites
  std::optional<double> spacing_mean;         ///< see BiteSkill [m]
  std::optional<double> along;                ///< mean position on the organ's axis, 0: apex, 1: pylorus
  std::optional<double> thread;               ///< between first and last bite, now; no value below two bites [m]
  double drawn = 0;                           ///< by the cinch [m]
  double tension = 0;                         ///< max over its segments, now [N]
  std::optional<double> cinch_tension;        ///< when the cinch was released; no value before [N]
  std::optional<double> duration;             ///< from the first bite to the release of the cinch [s]
};

/// @param organ  spacing is measured on its rest shape
BiteSkill measureBites(const Organ& organ, const std::vector<Suture>& sutures);

/// @param scene  null: nothing counts as loose
/// @param sets   result, one entry per suture; its memory is reused
void measureSets(const Organ& organ, const SutureScene* scene, const std::vector<Suture>& sutures,
                 std::vector<SetSkill>& sets);

/// Updates the members that change from step to step: thread, drawn, tension.
/// @param sets  from measureSets()
void updateSets(const std::vector<Suture>& sutures, std::vector<SetSkill>& sets);

}  // namespace vibe
