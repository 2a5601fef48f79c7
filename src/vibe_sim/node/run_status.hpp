#pragma once

namespace vibe::sim {

/// What the messages of a step say in addition to the session.
struct RunStatus {
  bool paused = false;
  bool scope_moves = false;       ///< scope/move_jp is under way
  bool overstitch_moves = false;  ///< overstitch/move_jp is under way
};

}  // namespace vibe::sim
