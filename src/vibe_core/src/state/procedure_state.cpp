#include "vibe_core/state/procedure_state.hpp"

namespace vibe {

const char* toString(Suture::Stage stage) {
  switch (stage) {
    case Suture::Stage::Open:
      return "open";
    case Suture::Stage::Tagged:
      return "tagged";
    case Suture::Stage::Cinching:
      return "cinching";
    case Suture::Stage::Cinched:
      return "cinched";
    case Suture::Stage::Broken:
      return "broken";
  }
  return "unknown";
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
  switch (phase) {
    case Phase::Inspect:
      return "inspect";
    case Phase::Mark:
      return "mark";
    case Phase::Suture:
      return "suture";
    case Phase::Pull:
      return "pull";
    case Phase::Done:
      return "done";
  }
  return "unknown";
}

}  // namespace vibe
