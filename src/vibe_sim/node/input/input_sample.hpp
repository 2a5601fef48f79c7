#pragma once

#include <cstdint>
#include <string>

namespace vibe::sim {

/// Which stamps a message of an input may have, compared with the simulator's time at its arrival. A node whose clock
/// is wrong is told so; its messages neither wait nor count.
struct InputWindow {
  std::int64_t look_ahead;  ///< later than that: refused [ns]
  std::int64_t staleness;   ///< older than that: refused [ns]

  static InputWindow ofWallClock() { return {500'000'000, 1'000'000'000}; }
  /// Nodes that follow /clock cannot be wrong, but may send motions ahead, or be slow.
  static InputWindow ofSimulatedTime() { return {60'000'000'000, INT64_MAX}; }
};

/// What is wrong with a stamp [ns] at the simulator's time `now` [ns], as the rest of a sentence: "its stamp is ...";
/// empty: nothing. Stamp 0, "as soon as possible", is always right.
std::string faultOf(std::int64_t stamp, std::int64_t now, const InputWindow& window);

}  // namespace vibe::sim
