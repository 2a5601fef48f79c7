#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "vibe_core/thermal/mark_zones.hpp"

namespace vibe {

/// Marks of a session: zones of particles with a grade that hang together, so a drawn line is one.
struct MarkSkill {
  int zones = 0;
  int inside = 0;                      ///< wholly in the working zone, see inWorkingZone()
  std::array<int, kWallCount> wall{};  ///< by the Wall of the zone's worst particle
  int burns = 0;                       ///< zones with a burn scar or worse
  int deep_burns = 0;                  ///< zones where the muscularis is at risk
  double area = 0;                     ///< of all, of the rest shape [m^2]
};

/// Counts zones from the grades that the state keeps. Some tens of microseconds; keeps its memory.
class MarkCounter {
 public:
  /// @param organ  must outlive this
  explicit MarkCounter(const Organ& organ);

  /// @param grades   BurnGrade by particle; of another size than the organ (a scene without marking): no zone
  /// @param x, y, z  where the particles are [m]
  MarkSkill count(const std::vector<std::uint8_t>& grades, const std::vector<double>& x, const std::vector<double>& y,
                  const std::vector<double>& z);

 private:
  const Organ& organ_;
  ThermalDose law_;  // any: grades go in and out of it as they are
  MarkFinder finder_;
  std::vector<float> dose_;
};

}  // namespace vibe
