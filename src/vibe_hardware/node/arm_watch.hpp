#pragma once

#include <cstdint>
#include <map>
#include <string>

#include <diagnostic_updater/diagnostic_updater.h>
#include <std_msgs/Header.h>

#include "vibe_hardware/crtk/teleop.hpp"

namespace vibe::hardware {

/// What crtk_teleop notices of an arm and its link, and what it says about them: in the log, each kind at most every 10
/// s, and on /diagnostics.
class ArmWatch {
 public:
  /// @param topic  of the measurements
  ArmWatch(const TeleopMapping& mapping, std::string topic, double now);

  void warn(const std::string& kind, const std::string& sentence);
  /// A message that cannot be used.
  void refuse(const std::string& topic, const std::string& what);
  /// Gives a measurement its time, of the clock of this computer. @param now  [s]
  /// @return false if its frame is another than that of the last one, so that the arm may be elsewhere
  bool take(const std_msgs::Header& header, double now, ArmSample& sample);
  /// An arm that does not measure what the mapping names may measure something else.
  /// @param pose, joints  topics of an arm that measures the one or the other
  void lookForTheArm(bool heard, double now, const std::string& pose, const std::string& joints);
  void withheld(double share);  ///< of a force of the tissue, by an account of energy

  const std::string& topic() const { return topic_; }
  const std::string& baseFrame() const { return base_frame_; }

  /// Adds what was noticed since the last entry. @param state  now
  void fill(const TeleopState& state, diagnostic_updater::DiagnosticStatusWrapper& status);

 private:
  const TeleopMapping& mapping_;
  std::string topic_, base_frame_;
  std::map<std::string, double> said_;  // when a warning of a kind was given last [s]
  ArmSample still_;                     // the first of equal measurements
  double worst_age_ = 0;                // of a measurement at its arrival, since the last entry [s]
  double withheld_ = 0;                 // largest share since then
  std::uint64_t samples_ = 0, samples_before_ = 0, invalid_ = 0;
  double next_look_;  // for an arm that is silent [s]

  double timeOf(const std_msgs::Header& header, double now);
};

}  // namespace vibe::hardware
