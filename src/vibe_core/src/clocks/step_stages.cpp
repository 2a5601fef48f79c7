#include "vibe_core/clocks/step_stages.hpp"

#include "vibe_core/clocks/step_timer.hpp"
#include "vibe_core/program/word_of.hpp"

namespace vibe {

const char* toString(StepStage stage) {
  return wordOf(stage, {"loads", "factor", "energy", "inverse", "rows", "paths", "walls", "other"}, "");
}

void StageClock::start() {
  seconds_.fill(0);
  stage_ = StepStage::Other;
  since_ = threadCpuTime();
}

const StageTimes& StageClock::stop() {
  enter(StepStage::Other);
  return seconds_;
}

StepStage StageClock::enter(StepStage stage) {
  const double now = threadCpuTime();
  seconds_[static_cast<std::size_t>(stage_)] += now - since_;
  since_ = now;
  const StepStage before = stage_;
  stage_ = stage;
  return before;
}

}  // namespace vibe
