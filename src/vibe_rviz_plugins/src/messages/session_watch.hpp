#pragma once
#include <string>

namespace vibe {

// Times are of a steady clock [s].

constexpr double kGoneAfter = 3;  ///< the simulator sends at least once a second of wall time, even while paused [s]

/// Whether the simulator is there, from when it was heard last.
class SimulatorWatch {
 public:
  void heard(double now) {
    last_ = now;
    ever_ = true;
  }
  /// Another namespace: nothing was heard there.
  void forget() { ever_ = false; }
  bool waits() const { return !ever_; }
  bool isGone(double now) const { return ever_ && now - last_ > kGoneAfter; }
  double silence(double now) const { return now - last_; }

  /// One sentence; empty if all is well.
  /// @param topic  full name of the one that is listened to
  std::string complaint(const std::string& topic, double now) const;

 private:
  double last_ = 0;
  bool ever_ = false;
};

/// Who presses the buttons. The simulator obeys one publisher of a topic, the first, until that one has been silent for
/// two seconds, and refuses any other.
class ControlWatch {
 public:
  /// A message of somebody else's has come.
  void heard(const std::string& publisher, double now) {
    publisher_ = publisher;
    last_ = now;
  }
  void forget() { publisher_.clear(); }
  /// The other one that is obeyed; empty: none.
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

/// The greatest number of the last whole second.
class MaxOfWindow {
 public:
  void add(double value, double now);
  /// NaN if nothing has come for a while, or not for long enough.
  double value(double now) const;

 private:
  double begin_ = -1e9, max_ = 0, last_ = 0;
  bool has_last_ = false;
};

/// Empty if a namespace can be used, else one sentence.
std::string checkNamespace(const std::string& name);

}  // namespace vibe
