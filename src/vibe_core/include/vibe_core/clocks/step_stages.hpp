#pragma once
#include <array>
#include <cstddef>
#include <cstdint>

namespace vibe {

/// What a step of the implicit solver spends its time on.
enum class StepStage : std::uint8_t {
  Loads,    ///< what acts on the tissue: where the tool touches it, grip, threads, gas
  Factor,   ///< the factor that is due is taken over, and the columns of rows that are new; not the factorisation
  Energy,   ///< energy and gradient of wall, foundation, gas and walls in contact
  Inverse,  ///< directions: history of the iterations, forward and backward substitution in the factor
  Rows,     ///< forces of contacts, grip and threads
  Paths,    ///< whether anything has gone through: walls through walls, the tool through the wall
  Walls,    ///< walls that have come near each other
  Other     ///< all else
};
constexpr int kStepStages = 8;  ///< values of StepStage

const char* toString(StepStage stage);

/// CPU time of the stepping thread by StepStage [s].
using StageTimes = std::array<double, kStepStages>;

/// Which stage the time goes to. Time belongs to one stage only: entering one leaves the one before. Reading the clock
/// takes some 0.3 us, 20 us in a step.
class StageClock {
 public:
  /// From zero, in StepStage::Other.
  void start();
  /// Ends the measurement.
  /// @returns the times since start(); they stay until the next one [s]
  const StageTimes& stop();
  /// @returns the stage before
  StepStage enter(StepStage stage);

 private:
  StageTimes seconds_{};
  StepStage stage_ = StepStage::Other;
  double since_ = 0;
};

/// As long as it lives, time belongs to a stage.
class InStage {
 public:
  /// @param clock  null: nothing is measured
  InStage(StageClock* clock, StepStage stage) : clock_(clock) {
    if (clock_ != nullptr) before_ = clock_->enter(stage);
  }
  ~InStage() {
    if (clock_ != nullptr) clock_->enter(before_);
  }
  InStage(const InStage&) = delete;
  InStage& operator=(const InStage&) = delete;

 private:
  StageClock* clock_;
  StepStage before_ = StepStage::Other;
};

}  // namespace vibe
