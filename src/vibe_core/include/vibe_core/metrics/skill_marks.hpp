#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "vibe_core/thermal/mark_zones.hpp"

namespace vibe {

/// Marks of a session. Connected particles with a grade are one zone, so a line is one.
struct MarkSkill {
  int zones = 0;
  int inside = 0;                      ///< completely in the working zone, see inWorkingZone()
  std::array<int, kWallCount> wall{};  ///< by the Wall of the zone's worst particle
  int burns = 0;                       ///< zones with a burn scar or worse
  int deep_burns = 0;                  ///< zones where the muscularis is at risk
  double area = 0;                     ///< of all, of the rest shape [m^2]
};

/// Counts zones from the grades in the state. Takes some tens of microseconds and reuses its memory.
class MarkCounter {
 public:
  /// @param organ  must outlive this
  explicit MarkCounter(const Organ& organ);

  /// @param grades   BurnGrade by particle; with another size than the organ (a scene without marking): no zone
  /// @param x, y, z  positions of the particles [m]
  MarkSkill count(const std::vector<std::uint8_t>& grades, const std::vector<double>& x, const std::vector<double>& y,
                  const std::vector<double>& z);

 private:
  const Organ& organ_;
  ThermalDose law_;  // any parameters: grades map to doses and back
  MarkFinder finder_;
  std::vector<float> dose_;
};

}  // namespace vibe
