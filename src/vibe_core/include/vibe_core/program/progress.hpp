#pragma once
#include <functional>
#include <string>

namespace vibe {

/// Callback of long operations (mesh import, remeshing, model building): the current activity and its progress [0, 1].
/// May be empty.
using Progress = std::function<void(const std::string& what, double fraction)>;

}  // namespace vibe
