#include "vibe_core/state/procedure_state.hpp"

#include "vibe_core/program/word_of.hpp"

namespace vibe {

const char* toString(Suture::Stage stage) {
  return wordOf(stage, {"open", "tagged", "cinching", "cinched", "broken"});
}

Eigen::Vector3d restPosition(const Bite& bite, const std::vector<Eigen::Vector3d>& vertices) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t k = 0; k < bite.particle.size(); ++k) sum += bite.weight[k] * vertices[bite.particle[k]];
  return sum;
}

Eigen::Vector3d bitePosition(const Bite& bite, const std::vector<double>& x, const std::vector<double>& y,
                             const std::vector<double>& z) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t k = 0; k < bite.particle.size(); ++k) {
    const int i = bite.particle[k];
    sum += bite.weight[k] * Eigen::Vector3d(x[i], y[i], z[i]);
  }
  return sum;
}

const char* toString(Phase phase) {
  return wordOf(phase, {"inspect", "mark", "suture", "pull", "done"});
}

}  // namespace vibe
