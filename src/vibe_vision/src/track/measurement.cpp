#include "vibe_vision/track/measurement.hpp"

namespace vibe::vision {

const char* toText(LostReason reason) {
  switch (reason) {
    case LostReason::None:
      return "tracked";
    case LostReason::NotFound:
      return "nothing along the axis looks like the marker";
    case LostReason::Occluded:
      return "too little of the marker is visible";
    case LostReason::Saturated:
      return "the image is too bright";
    case LostReason::Dark:
      return "the image is too dark";
    case LostReason::Mismatch:
      return "pattern, size or tilt is not that of the marker";
    case LostReason::Jump:
      return "it would have moved faster than the instrument can";
    case LostReason::OutOfView:
      return "the marker leaves the image";
    case LostReason::WrongImage:
      return "the image does not have the size of the calibration";
    case LostReason::NoFrame:
      return "no image";
  }
  return "unknown";
}

}  // namespace vibe::vision
