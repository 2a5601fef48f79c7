#include "vibe_firmware/core/sample.hpp"

#include <cmath>
#include <cstddef>
#include <cstdlib>

namespace vibe_firmware {

namespace {

/// to - from, of counters that wrap: the shorter way round.
std::int32_t difference(std::uint32_t to, std::uint32_t from, int bits) {
  const auto shift = static_cast<unsigned>(32 - bits);
  return static_cast<std::int32_t>((to - from) << shift) >> shift;
}

/// Counts to add so that the index pulse is a whole number of turns from the first one.
std::int32_t indexError(std::int32_t distance, std::int32_t turn) {
  std::int32_t remainder = distance % turn;
  if (remainder > turn / 2) remainder -= turn;
  if (remainder < -turn / 2) remainder += turn;
  return -remainder;
}

void useIndex(const AxisConfig& config, std::int32_t index_count, EncoderState& state) {
  const auto turn = static_cast<std::int32_t>(config.counts_per_turn);
  if (turn < 1) return;
  if (!state.indexed) {
    state.index_count = index_count;
    state.indexed = true;
    return;
  }
  const std::int32_t error = indexError(index_count - state.index_count, turn);
  if (std::abs(error) > turn / 8) state.fault = true;
  if (std::abs(error) > 1 && !state.fault) state.count += error;
}

}  // namespace

std::int32_t step(const AxisConfig& config, int counter_bits, const EncoderSample& sample, EncoderState& state) {
  if (!state.started) {
    state.counter = sample.counter;
    state.started = true;
  }
  const std::int32_t moved = difference(sample.counter, state.counter, counter_bits);
  const float distance = std::fabs(static_cast<float>(moved) * config.radians_per_count);
  state.counter = sample.counter;
  if (distance > config.speed_limit * config.sample_period || std::abs(state.count) > kMaxCount) state.fault = true;
  if (state.fault) return 0;
  state.count += moved;
  if (sample.index)
    useIndex(config, state.count + difference(sample.index_counter, sample.counter, counter_bits), state);
  return moved;
}

void step(std::uint8_t ticks, std::uint16_t contacts, DebouncerState& state) {
  const auto changed = static_cast<std::uint16_t>(contacts ^ state.buttons);
  for (std::size_t i = 0; i < kButtonCount; ++i) {
    if ((changed >> i & 1) == 0) {
      state.differs[i] = 0;
    } else if (++state.differs[i] >= ticks) {
      state.buttons = static_cast<std::uint16_t>(state.buttons ^ (1U << i));
      state.differs[i] = 0;
    }
  }
}

}  // namespace vibe_firmware
