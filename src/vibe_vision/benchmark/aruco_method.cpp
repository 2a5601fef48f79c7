#include <cmath>
#include <opencv2/aruco.hpp>

#include "method.hpp"
#include "tag_search.hpp"

namespace vibe::vision {
namespace {

constexpr int kBits = 4;

cv::Ptr<cv::aruco::Dictionary> dictionary() {
  return cv::aruco::getPredefinedDictionary(cv::aruco::DICT_4X4_50);
}

/// cv::aruco with CORNER_REFINE_SUBPIX, otherwise as it comes. The window of the refinement stays within one cell: a
/// larger one finds corners of the cells inside.
class ArucoMethod : public Method {
 public:
  std::string name() const override { return "aruco"; }
  std::size_t instrument(const BenchScene& scene) const override { return scene.aruco; }

  MethodRun run(const BenchScene& scene, const std::vector<RenderedFrame>& frames) override {
    const SyntheticInstrument& tag = scene.scene.instruments[scene.aruco];
    const double cell = tag.tag.side * tag.nominal.axis.pixels_per_metre / tag.tag.cells;
    parameters_->cornerRefinementMethod = cv::aruco::CORNER_REFINE_SUBPIX;
    parameters_->cornerRefinementWinSize = std::max(1, static_cast<int>(cell / 2));
    return runTagDetector(scene, scene.aruco, frames, [this](const ImageView& view) { return detect(view); });
  }

 private:
  std::vector<Corners> detect(const ImageView& view) {
    const cv::Mat image(view.height, view.width, CV_8UC1, const_cast<std::uint8_t*>(view.data),
                        static_cast<std::size_t>(view.stride));
    std::vector<std::vector<cv::Point2f>> corners;
    std::vector<int> ids;
    cv::aruco::detectMarkers(image, dictionary_, corners, ids, parameters_);
    std::vector<Corners> tags;
    for (std::size_t i = 0; i < ids.size(); ++i) {
      if (ids[i] != kArucoId) continue;
      tags.emplace_back();
      for (std::size_t k = 0; k < 4; ++k) tags.back()[k] = {corners[i][k].x, corners[i][k].y};
    }
    return tags;
  }

  cv::Ptr<cv::aruco::Dictionary> dictionary_ = dictionary();
  cv::Ptr<cv::aruco::DetectorParameters> parameters_ = cv::aruco::DetectorParameters::create();
};

}  // namespace

SyntheticTag arucoTag(double side) {
  cv::Mat picture;
  dictionary()->drawMarker(kArucoId, kBits + 2, picture, 1);
  SyntheticTag tag;
  tag.cells = kBits + 2;
  tag.side = side;
  for (int y = 0; y < tag.cells; ++y)
    for (int x = 0; x < tag.cells; ++x) tag.white.push_back(picture.at<std::uint8_t>(y, x) > 127 ? 1 : 0);
  return tag;
}

std::unique_ptr<Method> makeAruco() {
  return std::make_unique<ArucoMethod>();
}

}  // namespace vibe::vision
