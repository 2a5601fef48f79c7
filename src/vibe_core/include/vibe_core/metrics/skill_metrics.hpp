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
  int mild = 0, brisk = 0;  ///< begun
  int now = 0;              ///< of these, that bleed now
  int overdue = 0;          ///< brisk ones that were not stopped in time
  double lost = 0;          ///< in total [m^3]
};

/// Counted from events, so since the start, the last reset or the last load.
struct MistakeSkill {
  int missed_bites = 0;     ///< the arm closed and met no tissue
  int withdrawn_bites = 0;  ///< the arm opened before the exchange had the needle
  int slips = 0;            ///< tissue torn off the helix
  int broken_threads = 0;
  int refused = 0;  ///< commands that could not act
};

/// How well the procedure is done so far; definitions and sources: docs/metrics.md. Phases and mistakes are what was
/// recorded; marks, bites, sets and bleeding are what the state holds, so a loaded state brings its own.
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

/// What measuring needs and is costly to make (some 40 ms for 3,618 particles): once per model, used in one thread.
struct SkillInstruments {
  /// @param model  its organ must outlive this
  explicit SkillInstruments(const Model& model);

  std::shared_ptr<SpectralArcLength> spectrum;
  std::shared_ptr<MarkCounter> marks;
  std::shared_ptr<OrganRuler> ruler;  ///< null: the organ cannot be measured
  std::string ruler_fault;            ///< then why
};

/// Keeps SkillMetrics up to date. Costs a few microseconds per step and 0.4 ms once per simulated second (the organ).
/// Asks for no memory but when marks or bites are added. Marks are counted ten times a second while they grow (40 us).
class SkillRecorder {
 public:
  SkillRecorder(const SkillInstruments& instruments, const Model& model, const State& start,
                const Eigen::Vector3d& tip);

  /// After a step with its events.
  /// @param tip  scope_tip in world, any without a tool [m]
  void record(const Model& model, const State& state, const Eigen::Vector3d& tip, const std::vector<Event>& events);

  const SkillMetrics& metrics() const { return metrics_; }

 private:
  void updateMarks(const Model& model, const State& state);
  void countMarks(const State& state);
  void readSutures(const Model& model, const ProcedureState& procedure);
  void countMistakes();

  std::shared_ptr<MarkCounter> marks_;
  PhaseRecorder phases_;
  OrganTracker organ_;
  EventCounts counts_;
  long counted_grades_ = 0;  // sum of all when marks were counted last
  int steps_ = 0;            // since then
  SkillMetrics metrics_;
};

}  // namespace vibe
