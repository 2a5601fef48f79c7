#pragma once

#include <cstdint>
#include <deque>
#include <limits>
#include <string>
#include <vector>

#include "axis_plant.hpp"
#include "cosim_frame.hpp"
#include "firmware_peer.hpp"
#include "scenario.hpp"

namespace vibe_firmware {

/// Replies of the firmware in a file, one after the other.
/// @throw std::runtime_error if the file cannot be written or read
void writeTrace(const std::string& file, const std::vector<CosimReply>& trace);
std::vector<CosimReply> readTrace(const std::string& file);

/// One sentence about the first difference between two traces; empty if there is none.
std::string firstDifference(const std::vector<CosimReply>& one, const std::vector<CosimReply>& other);

/// Runs a scenario: firmware and plant take turns, one period each.
class Lockstep {
 public:
  /// @param delay  whole periods by which the torque comes late; 0 is the firmware as it is
  Lockstep(FirmwarePeer& firmware, Scenario& scenario, std::uint32_t delay);

  /// Runs this many periods. @throw std::runtime_error if the firmware does not answer
  void run(std::uint32_t ticks);

  /// Everything that the firmware has answered, without the times.
  const std::vector<CosimReply>& trace() const { return trace_; }

  /// FNV-1a over the trace.
  std::uint64_t hash() const;

  /// Shortest and longest period between two interrupts [25 MHz counts].
  std::uint32_t shortestPeriod() const { return shortest_; }
  std::uint32_t longestPeriod() const { return longest_; }

 private:
  CosimRequest requestOf(std::uint32_t tick);
  void keep(CosimReply reply);
  void advance(std::uint32_t tick, const CosimReply& reply);

  FirmwarePeer& firmware_;
  Scenario& scenario_;
  std::vector<AxisPlant> plants_;
  std::uint32_t delay_;
  std::deque<CosimReply> late_;
  std::vector<CosimReply> trace_;
  std::uint32_t last_entry_ = 0;
  std::uint32_t shortest_ = std::numeric_limits<std::uint32_t>::max();
  std::uint32_t longest_ = 0;
};

}  // namespace vibe_firmware
