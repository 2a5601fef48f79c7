#include "conversions/timing_message.hpp"

namespace vibe::sim {

void setWork(const StepReport& report, vibe_msgs::StepTiming& message) {
  const auto seconds = [&report](StepStage stage) {
    return static_cast<float>(report.stage_times[static_cast<std::size_t>(stage)]);
  };
  message.stage_loads = seconds(StepStage::Loads);
  message.stage_factor = seconds(StepStage::Factor);
  message.stage_energy = seconds(StepStage::Energy);
  message.stage_inverse = seconds(StepStage::Inverse);
  message.stage_rows = seconds(StepStage::Rows);
  message.stage_paths = seconds(StepStage::Paths);
  message.stage_walls = seconds(StepStage::Walls);
  message.stage_other = seconds(StepStage::Other);
  message.iterations = report.iterations;
  message.evaluations = report.evaluations;
  message.rows = report.rows;
  message.wall_pairs = report.wall_pairs;
  message.arrived = report.arrived ? 1 : 0;
  message.fallback = report.fallback ? 1 : 0;
}

}  // namespace vibe::sim
