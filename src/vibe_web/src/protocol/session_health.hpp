#pragma once

#include <string>

namespace vibe::web {

constexpr double kStale = 2;        ///< states that are older are told as missing [s]
constexpr double kStalePaused = 3;  ///< the same during a pause, in which something comes once a second [s]

/// What is heard of a session.
struct SessionHealth {
  bool published = false;  ///< somebody publishes states, or was killed, of which ROS tells nobody
  bool paused = false;     ///< so says the simulator
  double silence = 0;      ///< since the last state, or word that it stays, or since somebody publishes [s]
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
