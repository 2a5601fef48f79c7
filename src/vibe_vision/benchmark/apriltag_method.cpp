#include <apriltag/apriltag.h>
#include <apriltag/tag36h11.h>

#include "method.hpp"
#include "tag_search.hpp"

namespace vibe::vision {
namespace {

struct Family {
  apriltag_family_t* family = tag36h11_create();
  ~Family() { tag36h11_destroy(family); }
};

/// libapriltag, one thread, without decimation.
class AprilTagMethod : public Method {
 public:
  explicit AprilTagMethod(bool refine_edges) : refine_edges_(refine_edges) {
    detector_->nthreads = 1;
    detector_->quad_decimate = 1;
    detector_->refine_edges = refine_edges;
    apriltag_detector_add_family(detector_, family_.family);
  }
  ~AprilTagMethod() override { apriltag_detector_destroy(detector_); }
  AprilTagMethod(const AprilTagMethod&) = delete;
  AprilTagMethod& operator=(const AprilTagMethod&) = delete;

  std::string name() const override { return refine_edges_ ? "apriltag" : "apriltag_unrefined"; }
  std::size_t instrument(const BenchScene& scene) const override { return scene.apriltag; }

  MethodRun run(const BenchScene& scene, const std::vector<RenderedFrame>& frames) override {
    return runTagDetector(scene, scene.apriltag, frames, [this](const ImageView& view) { return detect(view); });
  }

 private:
  std::vector<Corners> detect(const ImageView& view) {
    image_u8_t image = {view.width, view.height, view.stride, const_cast<std::uint8_t*>(view.data)};
    zarray_t* detections = apriltag_detector_detect(detector_, &image);
    std::vector<Corners> tags;
    for (int i = 0; i < zarray_size(detections); ++i) {
      apriltag_detection_t* detection = nullptr;
      zarray_get(detections, i, &detection);
      if (detection->id != kAprilTagId) continue;
      // the library's pixel centres are at +0.5
      tags.emplace_back();
      for (std::size_t k = 0; k < 4; ++k) tags.back()[k] = {detection->p[k][0] - 0.5, detection->p[k][1] - 0.5};
    }
    apriltag_detections_destroy(detections);
    return tags;
  }

  bool refine_edges_;
  Family family_;
  apriltag_detector_t* detector_ = apriltag_detector_create();
};

}  // namespace

SyntheticTag aprilTag(double side) {
  const Family family;
  const apriltag_family_t& f = *family.family;
  const auto cells = static_cast<std::size_t>(f.width_at_border);
  SyntheticTag tag;
  tag.cells = f.width_at_border;
  tag.side = side;
  tag.white.assign(cells * cells, 0);
  for (std::uint32_t i = 0; i < f.nbits; ++i)  // as apriltag_to_image() does
    if ((f.codes[kAprilTagId] >> (f.nbits - 1 - i)) & 1) tag.white[f.bit_y[i] * cells + f.bit_x[i]] = 1;
  return tag;
}

std::unique_ptr<Method> makeAprilTag(bool refine_edges) {
  return std::make_unique<AprilTagMethod>(refine_edges);
}

}  // namespace vibe::vision
