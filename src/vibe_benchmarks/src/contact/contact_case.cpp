#include "contact/contact_case.hpp"

#include <limits>

namespace vibe::benchmarks {

std::shared_ptr<const Model> modelAt(const ContactCase& one, const ContactSetting& setting) {
  auto model = std::make_shared<Model>();
  model->scene = one.model->scene;
  model->organ = one.model->organ;
  model->scene.step_period = 1.0 / setting.rate;
  model->scene.tissue.iterations = setting.iterations;
  model->scene.tissue.spectral_radius = setting.spectral_radius;
  finishModel(one.urdf, *model);
  return model;
}

}  // namespace vibe::benchmarks
