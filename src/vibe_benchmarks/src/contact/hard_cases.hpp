#pragma once
#include <cstdint>
#include <iosfwd>
#include <string>
#include <vector>

#include "contact/hard_case.hpp"
#include "suture/wall_plan.hpp"

namespace vibe::benchmarks {

constexpr double kStrongTissue = 100;  ///< holds bites that do not tear out [N]

/// Names of the hard cases.
const std::vector<std::string>& hardCaseNames();

/// One line each.
std::string describeHardCases();

/// Prepares hard cases on a scene with gas, scope, helix and suture.
class HardCases {
 public:
  /// Builds the model and insufflates it.
  /// @param urdf   text of the scene's tool
  /// @param brief  shorter motions, fewer sets: seconds instead of minutes
  HardCases(const Scene& scene, std::string urdf, bool brief, std::ostream& log);

  /// @param seed  of the case `random`
  /// @throws Error for another name than those of hardCaseNames(), or if the start cannot be reached
  HardCase prepare(const std::string& name, std::uint64_t seed = 1);

  /// The session of a trainee script from the initial state of the scene on.
  /// @param longest  of it [s]
  /// @throws Error if the file is no trainee script
  HardCase session(const std::string& script, double longest) const;

 private:
  HardCase begin() const;
  HardCase ram(double speed) const;
  HardCase random(std::uint64_t seed) const;
  HardCase wind() const;
  HardCase jump(std::uint64_t seed) const;
  StepInput takeHold(HardCase& hard) const;
  HardCase cinchAcross() const;
  HardCase desufflate() const;
  HardCase manySets(int sets, int bites) const;
  HardCase setOverSet() const;
  HardCase pressureSteps() const;
  HardCase sleeve() const;
  std::vector<std::vector<WallPoint>> sleeveSets() const;
  void addSet(const std::vector<WallPoint>& spots, const StepInput& hold, HardCase& hard) const;
  std::vector<std::vector<WallPoint>> setsOf(int sets, int bites, double half_width, double share) const;

  std::shared_ptr<const Model> model_;
  std::string urdf_;
  State settled_;
  bool brief_;
};

}  // namespace vibe::benchmarks
