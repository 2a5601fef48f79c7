#pragma once

#include <string>

namespace vibe::web {

constexpr double kStale = 2;  ///< states that are older are told as missing [s]

/// What is heard of a session.
struct SessionHealth {
  bool published = false;  ///< somebody publishes states
  bool paused = false;     ///< so says the simulator
  bool rests = false;      ///< a recording that does not play
  double silence = 0;      ///< since the last state, or since somebody publishes them [s]
  bool robot = false;      ///< there is a robot description
  bool base = false;       ///< its place in the world is known
};

/// What a person who looks has to know.
struct HealthNote {
  std::string text;    ///< one sentence; empty: all is well
  bool alarm = false;  ///< what is shown is not what is
};

/// The most important of what is wrong.
HealthNote noteOf(const SessionHealth& health);

}  // namespace vibe::web
