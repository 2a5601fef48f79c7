#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "vibe_core/events/event.hpp"
#include "vibe_core/metrics/organ_measures.hpp"
#include "vibe_core/model/model.hpp"
#include "vibe_core/state/state.hpp"

namespace vibe {

/// What the organ is compared with.
enum class OrganReference : std::uint8_t {
  Rest = 0,      ///< the rest shape, without gas and tool: before one of the others, or for a state that was loaded
                 ///< with marks or bites
  SetPoint = 1,  ///< when the insufflator first reached its set point, before any mark or bite
  FirstAct = 2   ///< at the first mark or when the needle first pierced the wall, if that was earlier
};
/// "rest", "set point", "first act".
const char* toString(OrganReference reference);

/// How the organ has changed. Without values if the organ cannot be measured.
struct OrganSkill {
  OrganReference reference = OrganReference::Rest;
  double reference_pressure = 0;           ///< gauge, of the reference [Pa]
  double pressure = 0;                     ///< gauge, at the last measurement [Pa]
  std::optional<OrganMeasures> before;     ///< the reference
  std::optional<OrganMeasures> now;        ///< at the last measurement
  std::optional<double> area_reduction;    ///< of mean_area, 1 - now / before; negative: more than before [1]
  std::optional<double> volume_reduction;  ///< [1]
  std::optional<double> length_reduction;  ///< of the axis [1]
  std::string fault;                       ///< why the organ cannot be measured; empty: it can
};

/// Measures the organ once per simulated second, and when the reference is taken.
class OrganTracker {
 public:
  /// @param ruler  of the model's organ; null: it cannot be measured
  /// @param fault  the reason in that case
  OrganTracker(std::shared_ptr<OrganRuler> ruler, std::string fault, const State& start);

  /// Call after a step with its events.
  void record(const Model& model, const State& state, const std::vector<Event>& events);

  const OrganSkill& measures() const { return skill_; }

 private:
  void measure(const State& state);
  void takeReference(OrganReference reference, const State& state);
  void compare();

  std::shared_ptr<OrganRuler> ruler_;
  OrganSkill skill_;
  bool waits_ = false;  // for a reference other than rest
  long steps_ = 0;      // since the last measurement
};

}  // namespace vibe
