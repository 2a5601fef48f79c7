#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "vibe_core/events/event.hpp"
#include "vibe_core/metrics/organ_measures.hpp"
#include "vibe_core/metrics/skill_acts.hpp"
#include "vibe_core/metrics/skill_phases.hpp"
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
  OrganReference reference = OrganReference::Rest;  ///< which state `before` is of
  double reference_pressure = 0;                    ///< gauge, of the reference [Pa]
  double pressure = 0;                              ///< gauge, at the last measurement [Pa]
  std::optional<OrganMeasures> before;              ///< the reference
  std::optional<OrganMeasures> now;                 ///< at the last measurement
  std::optional<double> area_reduction;    ///< of mean_area, 1 - now / before; negative: more than before (ratio)
  std::optional<double> volume_reduction;  ///< ratio
  std::optional<double> length_reduction;  ///< of the axis (ratio)
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

  /// As of the last measurement, up to a second of simulated time ago.
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

struct BleedingSkill {
  int mild = 0, brisk = 0;  ///< that have begun
  int now = 0;              ///< of these: bleeding now
  int overdue = 0;          ///< brisk ones that were not stopped in time
  double lost = 0;          ///< in total [m^3]
};

/// Counts of events since the start, the last reset or the last load.
struct MistakeSkill {
  int missed_bites = 0;     ///< the arm closed and met no tissue
  int withdrawn_bites = 0;  ///< the arm opened before the exchange had the needle
  int slips = 0;            ///< tissue torn off the helix
  int broken_threads = 0;   ///< threads that broke because of their tension
  int rejected = 0;         ///< commands that could not act
};

/// Skill measures of the procedure so far; definitions and sources: docs/metrics.md. Phases and mistakes are recorded;
/// marks, bites, sets and bleeding follow from the state, so a loaded state brings its own.
struct SkillMetrics {
  PhasesSkill phases;          ///< motion and force, by phase and in all
  MarkSkill marks;             ///< places that the argon beam has coagulated
  BiteSkill bites;             ///< of all sets together
  std::vector<SetSkill> sets;  ///< in the order of their first bites
  BleedingSkill bleeding;      ///< of all bites together
  MistakeSkill mistakes;       ///< what did not succeed
  OrganSkill organ;            ///< how its shape has changed
};

/// Counts the bleedings of a state, those that have stopped included.
BleedingSkill measureBleeding(const ProcedureState& procedure);

/// What the measures need and what is expensive to make (some 40 ms for 3,618 particles): once per model, for one
/// thread.
struct SkillInstruments {
  /// @param model  its organ must outlive this
  explicit SkillInstruments(const Model& model);

  std::shared_ptr<SpectralArcLength> spectrum;  ///< tables for the smoothness, shared by all phases
  std::shared_ptr<MarkCounter> marks;           ///< memory for counting zones on the model's organ
  std::shared_ptr<OrganRuler> ruler;            ///< null: the organ cannot be measured
  std::string ruler_fault;                      ///< the reason in that case
};

/// Keeps SkillMetrics up to date. Costs a few microseconds per step and 0.4 ms once per simulated second (the organ).
/// Allocates only when marks or bites are added. Growing marks are counted ten times a second (40 us).
class SkillRecorder {
 public:
  /// @param start  state before the first step; marks, bites and bleeding that it has already count
  /// @param tip    position of scope_tip at the start, in world [m]; ignored without a tool
  SkillRecorder(const SkillInstruments& instruments, const Model& model, const State& start,
                const Eigen::Vector3d& tip);

  /// Call after a step with its events.
  /// @param tip  position of scope_tip in world [m]; ignored without a tool
  /// @param counts  of all events so far, with those of the step
  void record(const Model& model, const State& state, const Eigen::Vector3d& tip, const std::vector<Event>& events,
              const EventCounts& counts);

  /// As of the last record(); before the first, those of the start.
  const SkillMetrics& metrics() const { return metrics_; }

 private:
  void updateMarks(const Model& model, const State& state);
  void countMarks(const State& state);
  void readSutures(const Model& model, const ProcedureState& procedure);
  void readMistakes(const EventCounts& counts);

  std::shared_ptr<MarkCounter> marks_;
  PhaseRecorder phases_;
  OrganTracker organ_;
  long counted_grades_ = 0;  // sum of all grades at the last count
  int steps_ = 0;            // since then
  SkillMetrics metrics_;
};

}  // namespace vibe
