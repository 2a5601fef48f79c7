#pragma once
#include <array>
#include <cstdint>
#include <functional>
#include <iosfwd>
#include <memory>
#include <vector>

#include "vibe_core/model/model.hpp"
#include "vibe_core/state/state.hpp"

namespace vibe::benchmarks {

/// What the wall does in the last second in which all inputs are constant.
enum class HeldWall {
  Rests,    ///< no particle is faster than 10 um/s
  Creeps,   ///< its motion goes one way: it is still on its way, or slides
  Trembles  ///< it goes to and fro: a limit cycle
};

const char* nameOf(HeldWall wall);

/// Tells rest, creep and limit cycles from the positions of a second, step by step.
class RestDetector {
 public:
  /// @param step  period of the states [s]
  explicit RestDetector(double step) : step_(step) {}
  void add(const State& state);

  HeldWall wall() const;
  double speed() const { return speed_; }  ///< of the fastest particle, from step to step [m/s]
  double motion() const;  ///< diagonal of the box in which the particle stays that needs the largest [m]
  double drift()
      const;  ///< farthest that a particle is, in the mean, in the last third from where it was in the first [m]
  /// Steps after which all particles are where they were, to a tenth of the motion; 0: there is no such period.
  int period() const;

 private:
  using Positions = std::array<std::vector<double>, 3>;
  Positions mean(std::size_t begin, std::size_t end) const;

  double step_, speed_ = 0;
  std::vector<Positions> seen_;
};

/// A pose of the scope that was drawn at random, approached in 1.5 s, and held.
struct HeldPose {
  int particles = 0, pose = 0;
  std::array<double, kScopeJointCount> joints{};  ///< [m], [rad]
  double force = 0, force_range = 0;              ///< on the tool: at the end, and how far it varies [N]
  int contacts = 0;                               ///< at the end
  double motion = 0, drift = 0, speed = 0;        ///< see RestDetector
  int period = 0;                                 ///< likewise
  HeldWall wall = HeldWall::Rests;
};

/// Holds poses of the insufflated stomach, whose joints are uniform within the limits of the tool. The same seed draws
/// the same poses on all meshes.
/// @param hold  until the second in which the wall is looked at [s]
/// @param take  gets each pose as soon as it is known
void searchRest(std::shared_ptr<const Model> model, int poses, std::uint64_t seed, double hold,
                const std::function<void(const HeldPose&)>& take);

void writeHeldHeader(std::ostream& out);                      ///< CSV
void writeHeldPose(const HeldPose& pose, std::ostream& out);  ///< CSV

}  // namespace vibe::benchmarks
