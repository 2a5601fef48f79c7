#pragma once
#include <vector>

#include "geometry/tissue_mesh.hpp"

namespace vibe::rviz_plugins {

/// Time after which a mark is half way from white to brown, that is, tan. Design choice: sessions last 8 to 17 minutes,
/// in which the first marks shall be told from the last ones [s].
constexpr double kTanAge = 240;

/// How far a mark of this age has gone from white (0) over tan (1/2) to brown (1): 1 - 2^(-age / kTanAge) [1].
/// @param age  [s]
double browning(double age);

/// The age of marks and burns: the time since their grade last rose, as far as it was seen. Those of the first frame
/// are new in it.
class ScarAge {
 public:
  explicit ScarAge(const TissueMesh& mesh);

  /// @param frame  of this mesh. All marks are new again if its time is before that of the last frame, or if a grade
  ///               has fallen
  /// @return whether grades or browning have changed, in steps of 1/256
  bool see(const TissueFrame& frame);
  /// Grade times browning, one per vertex of the drawn surface, with the weights of its particles [1]. Divided by the
  /// grade with the same weights it is the mean browning of the marked ones, whatever is not marked beside them.
  std::vector<float> browned() const;

 private:
  std::vector<std::uint32_t> render_offsets_, render_particles_;
  std::vector<float> render_weights_;
  std::vector<std::uint8_t> grade_;  ///< of the last frame; 0 before the first
  std::vector<double> since_;        ///< when the grade rose [s]
  std::vector<float> of_particle_;   ///< grade times browning
  double time_ = 0;                  ///< of the last frame [s]
};

}  // namespace vibe::rviz_plugins
