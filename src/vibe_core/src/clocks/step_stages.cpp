#include "vibe_core/clocks/step_stages.hpp"

#include "vibe_core/clocks/step_timer.hpp"

namespace vibe {

const char* toString(StepStage stage) {
  switch (stage) {
    case StepStage::Loads:
      return "loads";
    case StepStage::Factor:
      return "factor";
    case StepStage::Energy:
      return "energy";
    case StepStage::Inverse:
      return "inverse";
    case StepStage::Rows:
      return "rows";
    case StepStage::Paths:
      return "paths";
    case StepStage::Walls:
      return "walls";
    case StepStage::Other:
      return "other";
  }
  return "";
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
