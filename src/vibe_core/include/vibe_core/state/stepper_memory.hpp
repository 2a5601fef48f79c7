#pragma once

#include <cstdint>
#include <vector>

namespace vibe {

/// What of its past a stepper needs for the next step, beside the motion: part of the state of a simulation. The factor
/// itself is only a cache: it is made again wherever a scratch does not hold the one that the memory names.
struct StepperMemory {
  std::vector<float> linearization_point;  ///< positions that the factor is about (3 * nodes); empty: rest
  std::vector<float> next;                 ///< positions of the next factor; empty: none is being made
  std::uint64_t linearization_id = 0;      ///< hash of `linearization_point`
  std::uint64_t next_id = 0;               ///< hash of `next`
  std::int64_t steps = 0;                  ///< taken
  std::int64_t due = 0;                    ///< step at which the next factor takes over
  double elastic_energy = 0;               ///< at the end of the last step [J]
  double usual_length = 0;                 ///< running mean of the first moves of the steps [m]
  int rest_steps = 0;                      ///< steps in a row in which nothing moved
  int recovery_steps = 0;                  ///< steps still to be taken straight towards rest
  int fallback = 0;                        ///< steps still to be taken with backward Euler and many iterations
};

}  // namespace vibe
