#pragma once
#include <string>

#include "vibe_core/input/step_input.hpp"
#include "vibe_core/trainee/timeline.hpp"
#include "vibe_core/trainee/tremor.hpp"

namespace vibe {

/// A scripted trainee: joint motions and button presses over time, read from YAML. docs/trainee_scripts.md describes
/// the format. A pure function of time and seed: at(t) gives the same bits on every call, run and machine with the same
/// libm.
class TraineeScript {
 public:
  /// @throws Error with file, line and remedy for input that does not follow the format.
  static TraineeScript load(const std::string& file);
  static TraineeScript parse(const std::string& yaml, const std::string& place);

  /// Input of the trainee at time t [s]. Constant before 0 and after duration().
  StepInput at(double time) const;

  double duration() const { return timeline_.duration(); }  ///< [s]
  const std::string& name() const { return name_; }

  /// Current phase at time t ("insert", "insufflate" ...), for the progress line.
  const std::string& phaseAt(double time) const;

 private:
  friend class ScriptReader;

  std::string name_;
  Timeline timeline_;
  Tremor tremor_;
};

}  // namespace vibe
