#pragma once
#include <string>

#include "vibe_core/input/step_input.hpp"
#include "vibe_core/trainee/timeline.hpp"
#include "vibe_core/trainee/tremor.hpp"

namespace vibe {

/// A scripted trainee: joint motions and button presses over time, read from YAML. Format in docs/trainee_scripts.md.
/// Pure function of time and seed: at(t) gives the same bits on every call, run and machine with the same libm.
class TraineeScript {
 public:
  /// @throws Error with file, line and remedy for anything the format does not know.
  static TraineeScript load(const std::string& file);
  static TraineeScript parse(const std::string& yaml, const std::string& place);

  /// What the trainee's hands do at time t [s]; before 0 as at 0, after duration() as at the end.
  StepInput at(double time) const;

  double duration() const { return timeline_.duration(); }  ///< [s]
  const std::string& name() const { return name_; }

  /// What the trainee says he does at time t ("insert", "insufflate" ...), for the progress line.
  const std::string& phaseAt(double time) const;

 private:
  friend class ScriptReader;

  std::string name_;
  Timeline timeline_;
  Tremor tremor_;
};

}  // namespace vibe
