#include "vibe_core/geometry/organ.hpp"

#include "vibe_core/program/word_of.hpp"

namespace vibe {

const char* toString(Region region) {
  return wordOf(region, {"cardia", "fundus", "body", "antrum", "pylorus"}, "unknown region");
}

const char* toString(Wall wall) {
  return wordOf(wall, {"anterior", "greater curvature", "posterior", "lesser curvature"}, "unknown wall");
}

const char* toString(End end) {
  return wordOf(end, {"none", "oesophagus", "duodenum"}, "unknown end");
}

}  // namespace vibe
