#pragma once
#include <functional>
#include <string>

namespace vibe {

/// Called by long work (mesh import, remeshing, model building): what is being done, and how far it is [0, 1].
/// An empty function is allowed and means that nobody listens.
using Progress = std::function<void(const std::string& what, double fraction)>;

}  // namespace vibe
