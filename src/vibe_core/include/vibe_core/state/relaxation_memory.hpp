#pragma once

#include <vector>

namespace vibe {

/// What a wall that relaxes (tissue.relaxation) has of its past. Empty in a wall that is elastic, and in one that has
/// never been strained. Stresses are as ShellElements::stress() gives them.
struct RelaxationMemory {
  std::vector<float> stress;      ///< of the law, at the end of the last step [N/m]
  std::vector<float> overstress;  ///< of each term in turn, what has not relaxed yet (terms * stress) [N/m]
  std::vector<double> held;       ///< energy that the overstress of each term holds [J]
  double energy = 0;              ///< of the law, at the end of the last step [J]
  double loss = 0;                ///< dissipated by relaxation, a sum like those of EnergyAccount [J]
};

}  // namespace vibe
