#pragma once
#include <array>
#include <functional>
#include <vector>

#include "method.hpp"

namespace vibe::vision {

using Corners = std::array<Eigen::Vector2d, 4>;  ///< pixels of the picture that was searched, centres are integers
/// Finds the corners of all tags with the number that is looked for.
using TagDetector = std::function<std::vector<Corners>(const ImageView&)>;

/// Runs a detector of tags on a window around the true place (which favours the tag: no prediction, no wrong window)
/// for accuracy, and on every few whole frames for the time and success of a search. Of several tags with one number
/// the one next to the axis counts, as an application would do that knows the axis.
MethodRun runTagDetector(const BenchScene& scene, std::size_t instrument, const std::vector<RenderedFrame>& frames,
                         const TagDetector& detector);

}  // namespace vibe::vision
