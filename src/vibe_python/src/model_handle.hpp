#pragma once
#include <memory>
#include <string>

#include "vibe_core/model/model.hpp"

namespace vibe::python {

/// The Python object `Model`.
struct ModelHandle {
  std::shared_ptr<const Model> model;
  std::string mesh_report;
};

}  // namespace vibe::python
