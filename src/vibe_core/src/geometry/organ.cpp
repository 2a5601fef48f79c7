#include "vibe_core/geometry/organ.hpp"

namespace vibe {

const char* toString(Region region) {
  switch (region) {
    case Region::Cardia:
      return "cardia";
    case Region::Fundus:
      return "fundus";
    case Region::Body:
      return "body";
    case Region::Antrum:
      return "antrum";
    case Region::Pylorus:
      return "pylorus";
  }
  return "unknown region";
}

const char* toString(Wall wall) {
  switch (wall) {
    case Wall::Anterior:
      return "anterior";
    case Wall::GreaterCurvature:
      return "greater curvature";
    case Wall::Posterior:
      return "posterior";
    case Wall::LesserCurvature:
      return "lesser curvature";
  }
  return "unknown wall";
}

const char* toString(End end) {
  switch (end) {
    case End::None:
      return "none";
    case End::Oesophagus:
      return "oesophagus";
    case End::Duodenum:
      return "duodenum";
  }
  return "unknown end";
}

}  // namespace vibe
