#pragma once
#include <cstdint>
#include <functional>
#include <iosfwd>
#include <memory>
#include <string>
#include <vector>

#include "output/result_row.hpp"
#include "vibe_core/model/model.hpp"
#include "vibe_core/simulation/simulation.hpp"

namespace vibe::benchmarks {

class WayCounts;

/// A stretch of a hard case.
struct HardPhase {
  std::string name;
  double duration = 1;  ///< [s]
  /// Command of the step that ends at a time after the start of the phase [s].
  std::function<StepInput(double end)> input;
  std::shared_ptr<const Model> model;             ///< that takes over; null: as before
  std::function<void(Simulation&)> prepare = {};  ///< called before the first step; empty: nothing
};

/// A phase without another model.
HardPhase phaseOf(const std::string& name, double duration, std::function<StepInput(double end)> input);
/// A phase in which the command stays.
HardPhase still(const std::string& name, double duration, const StepInput& input);

/// Something a simulator of contact has to survive.
struct HardCase {
  std::string name;
  std::shared_ptr<const Model> model;
  State start;
  State home;  ///< where tissue ends that returns
  std::vector<HardPhase> phases;
  bool returns = true;  ///< nothing lasting is done: the tissue has to end where it began
};

/// What is worst in any step, and what remains.
struct HardResult {
  std::string name;
  int steps = 0;
  StepTimes times;             ///< CPU of the stepping thread, without the first step of each model [ms]
  double real_time = 0;        ///< simulated time over that CPU time
  double iterations = 0;       ///< mean
  int max_iterations = 0;      ///< of a step
  int fallback_steps = 0;      ///< taken with backward Euler
  int crossings = 0;           ///< most pairs of triangles of the wall that cross at the end of a step
  int crossed_steps = 0;       ///< steps at whose end some cross
  int last_crossings = 0;      ///< at the end
  double first_crossing = -1;  ///< time of the first, of wall or tool; -1: none [s]
  int pierced = 0;             ///< most triangles through which the core of a shape of the tool passes
  double depth = 0;            ///< most of the wall's middle surface below the surface of the tool [m]
  int contacts = 0;            ///< most
  double force = 0;            ///< largest, on the tool [N]
  double grip_force = 0;       ///< largest, on the grip [N]
  double tension = 0;          ///< largest, of a thread [N]
  int slips = 0, tear_outs = 0, breaks = 0, recoveries = 0;  ///< events
  double work = 0;           ///< sum over the steps of |work| of tool, gas, threads and pull spring [J]
  double balance = 0;        ///< energyBalance() at the end minus that at the start [J]
  double worst_balance = 0;  ///< largest such difference at any time, with its sign [J]
  EnergyAccount account;     ///< at the end minus at the start [J]
  double speed = 0;          ///< fastest particle at the end [m/s]
  double away = 0;           ///< farthest particle from its place at home [m]
  bool returns = true;       ///< as in the case
  std::uint64_t hash = 0;
};

/// What runHardCase() writes beside its result.
struct HardOutput {
  std::ostream* steps = nullptr;  ///< one line of CSV per step; null: none
  WayCounts* ways = nullptr;      ///< counts the ways of the steps; null: they are not counted
};

/// Steps a case and looks at the end of every step for walls and tools that pass through each other.
HardResult runHardCase(const HardCase& hard, const HardOutput& output = {});

void writeHardResults(const std::vector<HardResult>& results, std::ostream& out);  ///< CSV
void writeHardStepHeader(std::ostream& out);

}  // namespace vibe::benchmarks
