#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "vibe_core/model/model.hpp"
#include "vibe_core/simulation/simulation.hpp"
#include "vibe_core/state/state.hpp"
#include "vibe_testing/tool_crossings.hpp"

namespace vibe::benchmarks {

class WayCounts;

/// Force that a case compares.
enum class ContactSignal { ToolForce, ThreadTension };

/// A start state with contact and the motion of the hand that follows, prescribed over time, so that any step period
/// gives the same motion.
struct ContactCase {
  std::string name;
  std::shared_ptr<const Model> model;  ///< at the step period at which it was prepared
  std::string urdf;                    ///< text, of the tool
  State start;                         ///< at time 0
  double duration = 1;                 ///< [s]
  /// Command of the step that ends at a time after the start [s].
  std::function<StepInput(double end)> input;
  ContactSignal signal = ContactSignal::ToolForce;
};

/// Settings of the implicit step, and how it is run.
struct ContactSetting {
  int rate = 60;                 ///< steps per second, a multiple of 60 [Hz]
  int iterations = 4;            ///< tissue.iterations
  double spectral_radius = 0.2;  ///< tissue.spectral_radius
  bool stages = false;           ///< says what the steps have spent their time on
  int threads = 1;               ///< used inside a step
  bool real_time = false;        ///< a step begins when its time has come, not as soon as the last one has ended
};

/// The force that the case compares [N].
Eigen::Vector3d signalOf(const ContactCase& one, const State& state);

/// Sum of |work| of tool, gas, threads and pull spring [J].
double workBetween(const EnergyAccount& a, const EnergyAccount& b);

/// The model of the case with another setting.
std::shared_ptr<const Model> modelAt(const ContactCase& one, const ContactSetting& setting);

/// Looks for walls and tools that pass through each other, with none of the solver's own contact.
class ContactCheck {
 public:
  explicit ContactCheck(const Model& model);

  /// Pairs of triangles without common vertex that intersect.
  std::vector<vibe::test::CrossingPair> wall(const State& state);

  /// The tool in the wall, without the open ends and what the helix holds.
  vibe::test::ToolCrossing tool(const State& state);

 private:
  const Model& model_;
  std::vector<char> open_, passes_;
  std::vector<Eigen::Isometry3d> poses_;
};

/// Record of a case at one setting.
struct ContactTrace {
  ContactSetting setting;
  std::vector<std::array<std::vector<double>, 3>> frames;  ///< positions every 1/60 s, from the start on [m]
  std::vector<Eigen::Vector3d> force;                      ///< mean over each frame [N]
  std::vector<double> cpu;   ///< of the stepping thread, each step but the first, which makes the first factor [ms]
  std::vector<double> wall;  ///< of the same steps [ms]
  double others = 0;         ///< CPU time of all other threads, mean of the same steps [ms]
  double iterations = 0;     ///< mean of the steps
  int max_iterations = 0;    ///< of a step
  int fallback_steps = 0;    ///< taken with backward Euler
  int contacts = 0;          ///< with the tool, most in a step
  int pairs = 0;             ///< of walls in contact, most in a frame
  int crossings = 0;         ///< pairs of triangles of the wall that cross, most at the end of a frame
  double depth = 0;          ///< of the wall's middle surface in the tool, most at the end of a frame [m]
  int events = 0;            ///< slips, tear-outs, broken threads and recoveries
  double balance = 0;        ///< energyBalance() at the end minus that at the start [J]
  double work = 0;           ///< sum over the steps of |work| of tool, gas, threads and pull spring [J]
  std::uint64_t hash = 0;    ///< of the last state
  std::string stages;        ///< StageSummary of all steps, if it was asked for
};

/// @param ways  counts the ways of its steps; null: they are not counted
ContactTrace runContact(const ContactCase& one, const ContactSetting& setting, WayCounts* ways = nullptr);

/// The steps of runContact() but the first; a function of its own for scripts/instructions, which counts in it.
const std::vector<Event>& countedStep(Simulation& simulation, const StepInput& input);

/// Of each step the shorter time counts.
/// @throws Error if the two end with different bits
void takeFaster(const ContactTrace& other, ContactTrace& trace);

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
