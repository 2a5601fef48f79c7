#pragma once
#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "contact/contact_case.hpp"

namespace vibe::benchmarks {

/// Record of a case at one setting.
struct ContactTrace {
  ContactSetting setting;
  std::vector<std::array<std::vector<double>, 3>> frames;  ///< positions every 1/60 s, from the start on [m]
  std::vector<Eigen::Vector3d> force;                      ///< mean over each frame [N]
  std::vector<double> cpu;  ///< of the stepping thread, each step but the first, which makes the first factor [ms]
  double iterations = 0;    ///< mean of the steps
  int max_iterations = 0;   ///< of a step
  int fallback_steps = 0;   ///< repeated with backward Euler
  int contacts = 0;         ///< with the tool, most in a step
  int pairs = 0;            ///< of walls in contact, most in a frame
  int crossings = 0;        ///< pairs of triangles of the wall that cross, most at the end of a frame
  double depth = 0;         ///< of the wall's middle surface in the tool, most at the end of a frame [m]
  int events = 0;           ///< slips, tear-outs, broken threads and recoveries
  double balance = 0;       ///< energyBalance() at the end minus that at the start [J]
  double work = 0;          ///< sum over the steps of |work| of tool, gas, threads and pull spring [J]
  std::uint64_t hash = 0;   ///< of the last state
};

/// @param repeats  runs; of each step the shortest time counts
/// @throws Error if two runs end with different bits
ContactTrace runContact(const ContactCase& one, const ContactSetting& setting, int repeats);

/// Differences of a trace from another one of the same case.
struct ContactErrors {
  double motion = 0;      ///< worst frame; root of the sum of squares, over the largest such distance from the start
  double motion_end = 0;  ///< last frame
  double force = 0;       ///< worst frame after the fifth, over the largest force
  double force_end = 0;   ///< last frame
  double largest = 0;     ///< force of the reference [N]
};
ContactErrors compareContact(const ContactTrace& trace, const ContactTrace& reference);

}  // namespace vibe::benchmarks
