#pragma once
#include <string>

namespace vibe::operating {

// Times are of a steady clock [s].

/// Now.
double steadySeconds();

constexpr double kGoneAfter = 3;  ///< the simulator sends at least once a second of wall time, even while paused [s]

/// Decides from the time of the last message whether the simulator is running.
class SimulatorWatch {
 public:
  /// A message of the simulator has come.
  void received(double now) {
    last_ = now;
    ever_ = true;
  }
  /// For another namespace, in which no message has come yet.
  void forget() { ever_ = false; }
  bool waits() const { return !ever_; }                                        ///< no message has come yet
  bool isGone(double now) const { return ever_ && now - last_ > kGoneAfter; }  ///< it has been silent for long
  double silence(double now) const { return now - last_; }                     ///< since the last message [s]

  /// One sentence; empty if all is well.
  /// @param topic  full name of the subscribed topic
  std::string problem(const std::string& topic, double now) const;

 private:
  double last_ = 0;
  bool ever_ = false;
};

/// Finds out who presses the buttons. The simulator obeys the first publisher of a topic until it has been silent for
/// two seconds, and ignores all others.
class ControlWatch {
 public:
  /// A message of another publisher has come.
  void received(const std::string& publisher, double now) {
    publisher_ = publisher;
    last_ = now;
  }
  void forget() { publisher_.clear(); }  ///< who has published
  /// The other publisher that is obeyed; empty: none.
  std::string rival(double now) const;

  /// Who has control, in one sentence.
  /// @param others     publishers besides this one
  /// @param listeners  subscribers besides this one
  std::string sentence(const std::string& topic, bool in_control, unsigned others, unsigned listeners,
                       double now) const;

 private:
  std::string publisher_;
  double last_ = 0;
};

/// Maximum of the last whole second.
class MaxOfWindow {
 public:
  void add(double value, double now);  ///< a value of now
  /// NaN if there was no value for a while, or if there is no whole second yet.
  double value(double now) const;

 private:
  double begin_ = -1e9, max_ = 0, last_ = 0;
  bool has_last_ = false;
};

/// @return empty if a namespace can be used; otherwise one sentence that says why not
std::string checkNamespace(const std::string& name);

}  // namespace vibe::operating
