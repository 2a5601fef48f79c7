#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "vibe_core/events/event.hpp"
#include "vibe_core/metrics/event_counts.hpp"
#include "vibe_core/metrics/skill_marks.hpp"
#include "vibe_core/metrics/skill_organ.hpp"
#include "vibe_core/metrics/skill_phases.hpp"
#include "vibe_core/metrics/skill_sutures.hpp"
#include "vibe_core/model/model.hpp"
#include "vibe_core/state/state.hpp"

namespace vibe {

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
  int broken_threads = 0;
  int rejected = 0;  ///< commands that could not act
};

/// Skill measures of the procedure so far; definitions and sources: docs/metrics.md. Phases and mistakes are recorded;
/// marks, bites, sets and bleeding follow from the state, so a loaded state brings its own.
struct SkillMetrics {
  PhasesSkill phases;
  MarkSkill marks;
  BiteSkill bites;
  std::vector<SetSkill> sets;  ///< in the order of their first bites
  BleedingSkill bleeding;
  MistakeSkill mistakes;
  OrganSkill organ;
};

BleedingSkill measureBleeding(const ProcedureState& procedure);

/// What the measures need and what is expensive to make (some 40 ms for 3,618 particles): once per model, for one
/// thread.
struct SkillInstruments {
  /// @param model  its organ must outlive this
  explicit SkillInstruments(const Model& model);

  std::shared_ptr<SpectralArcLength> spectrum;
  std::shared_ptr<MarkCounter> marks;
  std::shared_ptr<OrganRuler> ruler;  ///< null: the organ cannot be measured
  std::string ruler_fault;            ///< the reason in that case
};

/// Keeps SkillMetrics up to date. Costs a few microseconds per step and 0.4 ms once per simulated second (the organ).
/// Allocates only when marks or bites are added. Growing marks are counted ten times a second (40 us).
class SkillRecorder {
 public:
  SkillRecorder(const SkillInstruments& instruments, const Model& model, const State& start,
                const Eigen::Vector3d& tip);

  /// Call after a step with its events.
  /// @param tip  position of scope_tip in world [m]; ignored without a tool
  /// @param counts  of all events so far, with those of the step
  void record(const Model& model, const State& state, const Eigen::Vector3d& tip, const std::vector<Event>& events,
              const EventCounts& counts);

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
