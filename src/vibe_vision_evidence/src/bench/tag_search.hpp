#pragma once
#include <functional>
#include <vector>

#include "bench/method.hpp"
#include "vibe_vision/tag/tag_reader.hpp"

namespace vibe::vision::evidence {

/// Finds the corners of all tags with the number that is looked for.
using TagDetector = std::function<std::vector<TagCorners>(const ImageView&)>;

/// Runs a detector of tags on a window around the true place (which favours the tag: no prediction, no wrong window)
/// for accuracy, and on every few whole frames for the time and success of a search. Of several tags with one number
/// the one next to the axis counts, as an application would do that knows the axis.
MethodRun runTagDetector(const BenchScene& scene, std::size_t instrument, const std::vector<RenderedFrame>& frames,
                         const TagDetector& detector);

}  // namespace vibe::vision::evidence
