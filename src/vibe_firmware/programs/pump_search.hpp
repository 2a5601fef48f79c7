#pragma once
#include <cstddef>
#include <vector>

#include "vibe_firmware/core/axis_control.hpp"

namespace vibe_firmware {

/// Places where the hand may be at a sample: the lower and upper edges of cells of the encoder.
struct Lattice {
  int radius = 3;       ///< cells on each side of the equilibrium
  int stride = 1;       ///< of the cells, in counts: more than 1 for wide motions
  int velocities = 81;  ///< of the velocity filter
};

/// Energies of a hand that begins at rest in the equilibrium and moves for 400 ticks at most.
struct PumpResult {
  double available = 0;  ///< most that it can take out, from above: interpolation does not make it smaller [J]
  double bound = 0;      ///< by which `available` grows per tick in the end [J]
  double gain = 0;       ///< that the real function gives per tick along the motion that was found [J]; active if > 0
};

/// Looks for the motion of a hand that takes the most energy out of an axis with constant parameters.
///
/// The axis is the firmware's step() itself, cloned and driven as a black box. The hand may be at any place of the
/// lattice at each sample; between two samples it moves evenly, which loses least: b dx^2/T + f_c |dx|. The search is
/// dynamic programming over the place and the state of the velocity filter, between whose grid points the value is
/// interpolated. What it finds is confirmed by driving the real function along the motion.
class PumpSearch {
 public:
  /// The energy observer is switched off: its capacity is made infinite.
  PumpSearch(const AxisConfig& config, const AxisParameters& parameters, const Lattice& lattice);

  PumpResult run();

 private:
  struct Transition {
    float velocity = 0;  // of the filter at the next sample
    float torque = 0;
    std::size_t grid = 0;  // grid point below it
    double weight = 0;     // of the one above
  };

  std::size_t places() const { return 2 * cells_; }
  std::size_t index(std::size_t place, std::size_t velocity) const { return place * velocities_.size() + velocity; }
  int count(std::size_t cell) const { return (static_cast<int>(cell) - lattice_.radius) * lattice_.stride; }
  double position(std::size_t place) const;
  AxisState stateAt(std::size_t cell, float velocity) const;
  Transition move(std::size_t from_cell, float velocity, std::size_t to_cell) const;
  void tabulate();
  double gain(std::size_t from, double torque, std::size_t to) const;
  std::size_t best(std::size_t place, const AxisState& state) const;
  double sweep();
  double pump() const;

  AxisConfig config_;
  AxisParameters parameters_;
  Lattice lattice_;
  std::size_t cells_;
  std::vector<float> velocities_;
  std::vector<float> torque_;           // [cell, velocity]
  std::vector<Transition> transition_;  // [cell, velocity, next cell]
  std::vector<double> loss_;            // [place, next place] of the motion
  std::vector<double> value_, next_;    // [place, velocity]
};

}  // namespace vibe_firmware
