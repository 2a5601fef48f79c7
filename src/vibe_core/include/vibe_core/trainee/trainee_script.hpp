#pragma once

#include <array>
#include <string>
#include <vector>

#include "vibe_core/input/step_input.hpp"
#include "vibe_core/trainee/skill.hpp"

namespace vibe {

/// Motions, button edges and phases over time [s]. Entries are added in order of time for each joint and button, and
/// looked up by bisection.
class Timeline {
 public:
  /// Position of a joint before its first motion [m], [rad].
  void setStart(int joint, double position) { start_[joint] = position; }

  /// Adds a motion of a joint to a position between two times, with the profile minimumJerk(). begin must not lie
  /// before jointFreeAt().
  void addMotion(int joint, double begin, double end, double to);
  /// Presses or releases a button. The time must not lie before the button's last edge.
  void addEdge(int button, double time, bool pressed);
  /// A phase begins, and lasts until the next. The time must not lie before the beginning of the last one.
  void addPhase(double time, const std::string& name);
  /// Extends the timeline to at least this time.
  void extendTo(double time);

  double jointFreeAt(int joint) const;  ///< end time of its last motion, 0 without one
  double jointTarget(int joint) const;  ///< target of its last motion
  bool isPressed(int button) const;     ///< after its last edge
  double lastEdge(int button) const;    ///< time of its last edge; -infinity without one

  /// End of the last entry, or the time of extendTo() if that is later [s].
  double duration() const { return duration_; }
  double position(int joint, double time) const;  ///< of a joint, by its motions; between them it stays [m], [rad]
  bool pressed(int button, double time) const;    ///< whether a button is down; not before its first edge
  const std::string& phase(double time) const;    ///< empty before the first phase

 private:
  struct Motion {
    double begin;
    double end;
    double from;
    double to;
  };
  struct Edge {
    double time;
    bool pressed;
  };
  struct Phase {
    double time;
    std::string name;
  };
  std::array<double, kJointCount> start_{};
  std::array<std::vector<Motion>, kJointCount> motions_;
  std::array<std::vector<Edge>, kButtonCount> edges_;
  std::vector<Phase> phases_;
  double duration_ = 0;
};

/// A scripted trainee: joint motions and button presses over time, read from YAML. docs/trainee_scripts.md describes
/// the format. A pure function of time and seed: at(t) gives the same bits on every call, run and machine with the same
/// libm.
class TraineeScript {
 public:
  /// @throws Error with file, line and remedy for input that does not follow the format.
  static TraineeScript load(const std::string& file);
  /// Reads a text instead of a file, with the same errors.
  /// @param place  what to call it in errors, e.g. the name of its file
  static TraineeScript parse(const std::string& yaml, const std::string& place);

  /// Input of the trainee at time t [s]. Constant before 0 and after duration().
  StepInput at(double time) const;

  double duration() const { return timeline_.duration(); }  ///< [s]
  const std::string& name() const { return name_; }         ///< as the script states it

  /// Current phase at time t ("insert", "insufflate" ...), for the progress line.
  const std::string& phaseAt(double time) const;

 private:
  friend class ScriptReader;

  std::string name_;
  Timeline timeline_;
  Tremor tremor_;
};

}  // namespace vibe
