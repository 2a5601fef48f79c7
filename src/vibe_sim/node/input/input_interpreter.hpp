#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "input/input_queue.hpp"
#include "input/input_sample.hpp"
#include "input/joint_drivers.hpp"
#include "vibe_core/input/step_input.hpp"
#include "vibe_core/model/model.hpp"
#include "vibe_core/tool/tool_model.hpp"

namespace vibe::sim {

/// A motion of some joints from where they are to a goal, all in the same time: the path of least jerk from rest to
/// rest (Flash and Hogan 1985), as fast as the limits of the slowest joint allow. A function of time only.
class JointMove {
 public:
  /// @param start   of all joints [m], [rad]
  /// @param goal    read from joint `first` to `first + count - 1`, the ones that move; clamped to the limits
  /// @param limits  of position and velocity
  /// @param begin   stamp [ns]
  JointMove(const JointArray& start, const JointArray& goal, int first, int count,
            const std::array<JointLimits, kJointCount>& limits, std::int64_t begin);

  /// Sets the joints that move to their place on the path; before the begin that is the start, after the end the goal.
  void apply(std::int64_t stamp, JointArray& joints) const;
  std::int64_t end() const { return begin_ + duration_; }  ///< stamp [ns]

 private:
  JointArray start_, way_{};
  int first_, count_;
  std::int64_t begin_, duration_ = 0;
};

/// A pull ends if no message arrives for this long: its publisher may be gone [ns of the simulator's time].
constexpr std::int64_t kPullTimeout = 2'000'000'000;

/// Buttons that are pressed are released if no message arrives for this long: whoever presses them may be gone [ns of
/// the simulator's time].
constexpr std::int64_t kButtonTimeout = 1'000'000'000;

/// A velocity that is not sent again ends after this long: its sender may hang or be gone [ns of the simulator's time].
/// CRTK keeps the last setpoint of a velocity instead.
constexpr std::int64_t kVelocityLife = 300'000'000;

/// Releases all buttons if none has had a message for kButtonTimeout, where time passes as it does for who presses
/// them.
/// @return one sentence that names those that were pressed; empty: none
std::string releaseSilentButtons(const DueInput& due, StepInput& input);

/// Knows what samples mean to a model: makes the input of a step of those that are due, and keeps moves that are under
/// way. Belongs to the thread that steps.
class InputInterpreter {
 public:
  /// @param velocity_life  kVelocityLife, or what the user has chosen [ns]
  explicit InputInterpreter(std::int64_t velocity_life = kVelocityLife) : velocity_life_(velocity_life) {}

  /// Applies to `input` what is due and comes from who drives (JointDrivers); the last valid values stay in force.
  /// Targets of the tip become joints by the tool's inverse kinematics; a pull without a message for kPullTimeout ends.
  /// A move ends at its goal, when another sample for its joints is applied, or when the clock is set back; a velocity
  /// of the tip ends in the last two ways, and of itself: it fades in the last third of its life, which begins at the
  /// stamp of its sample.
  /// A button changes once in a step: one that is pressed and let go within a step is pressed for a step, this one or
  /// the next.
  /// @param hand  where the hand is, from where a move begins; empty: where `input` says
  /// @return one sentence per sample that the model cannot use, and one if a pull or a velocity has fallen silent
  std::vector<std::string> interpret(const DueInput& due, const Model& model, StepInput& input,
                                     const std::optional<JointArray>& hand = {});

  /// Whether a move of the scope or of the suturing device is under way.
  bool moves(InputChannel channel) const { return moves_[static_cast<std::size_t>(channel)].has_value(); }
  /// Ends all moves where they are, because another state has taken over.
  void endMoves() { moves_ = {}, twist_.reset(), drivers_ = {}, owed_ = {}; }

 private:
  using Buttons = std::array<std::uint8_t, kButtonCount>;
  struct Twist {
    Eigen::Matrix<double, 6, 1> velocity;  // of scope_tip in world
    std::int64_t begin;                    // of its life [ns]
  };

  std::int64_t velocity_life_;
  std::array<std::optional<JointMove>, kInputChannelCount> moves_;
  std::array<JointDrivers, 2> drivers_;   // of the scope and of the suturing device
  std::array<int, kButtonCount> owed_{};  // changes of a button that are to come, one a step
  std::optional<Twist> twist_;            // empty: scope_tip has no velocity of its own

  std::string applySample(const InputSample& sample, const DueInput& due, const Model& model, const JointArray& hand,
                          StepInput& input);
  void press(const Buttons& buttons, const Buttons& now);
  void changeButtons(Buttons& buttons);
  std::string beginMove(const InputSample& sample, std::int64_t stamp, const Model& model, const JointArray& hand);
  std::string beginTwist(const InputSample& sample, const DueInput& due, const Model& model);
  std::string applyTwist(const DueInput& due, const Model& model, const JointArray& hand, JointArray& joints);
  void applyMoves(std::int64_t stamp, JointArray& joints);
};

}  // namespace vibe::sim
