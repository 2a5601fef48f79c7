#include "bound/marker_bound.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "synthetic/tile_renderer.hpp"
#include "vibe_core/program/error.hpp"

namespace vibe::vision::evidence {
namespace {

constexpr double kShift = 0.05;          // half width of a difference [px]
constexpr double kRotationShift = 0.01;  // [rad]
constexpr float kWhole = 0.999F;         // share of a flat marker in a pixel that counts
constexpr float kCut = 0.5F;             // by which a sleeve is lengthened to find its ends [px]
constexpr float kNone = 1e-3F;           // change of a pixel that does not see them [DN]
constexpr float kSaturated = 254.0F;     // [DN]

using Picture = std::vector<float>;

/// Draws one marker of a scene with small changes.
class ChangedPictures {
 public:
  ChangedPictures(const SyntheticScene& scene, std::size_t instrument, std::uint64_t index)
      : scene_(scene), instrument_(instrument), tiles_(scene) {
    const double middle = static_cast<double>(index) / scene.rate, half = scene.degradation.exposure / 2;
    exposure_ = {middle - half, middle + half};
    const cv::Rect image(0, 0, scene.camera.width, scene.camera.height);
    rect_ = image & grown(tiles_.boundsOf(instrument, exposure_), tiles_.kernel().margin());
  }

  Picture draw() const {
    const int width = scene_.camera.width;
    Picture image(static_cast<std::size_t>(width) * static_cast<std::size_t>(scene_.camera.height)), piece;
    tiles_.render(rect_, exposure_, image.data());
    for (int y = rect_.y; y < rect_.br().y; ++y)
      for (int x = rect_.x; x < rect_.br().x; ++x)
        piece.push_back(image[static_cast<std::size_t>(y * width + x)] * static_cast<float>(vignetteAt(scene_, x, y)));
    return piece;
  }

  /// Derivative by a displacement. @param slide, lateral [m], rotation [rad]; @param size  of the step in its unit
  Picture derivative(double slide, double lateral, double rotation, double size) {
    const Picture plus = displaced(slide, lateral, rotation), minus = displaced(-slide, -lateral, -rotation);
    return difference(plus, minus, 2 * size);
  }

  /// 1 for pixels that count, 0 where the edge of the paper is seen: people cut it, it tells nothing. The outline of a
  /// rod counts.
  Picture mask() {
    SyntheticInstrument longer = scene_.instruments[instrument_];
    if (longer.tag.cells == 0 && std::holds_alternative<SleeveDesign>(longer.nominal.marker)) {
      auto& sleeve = std::get<SleeveDesign>(longer.nominal.marker);
      sleeve.length += 2 * kCut / (longer.nominal.axis.pixels_per_metre * longer.scale);
      const Picture before = draw();
      tiles_.setObject(instrument_, longer);
      Picture counted = difference(draw(), before, 1);
      tiles_.setObject(instrument_, scene_.instruments[instrument_]);
      for (float& value : counted) value = std::abs(value) < kNone ? 1.0F : 0.0F;
      return counted;
    }
    Picture share = sum(inkDerivative(1, 0), inkDerivative(0, 1));
    const double light = meanLight(scene_.degradation, exposure_.begin, exposure_.end);
    auto value = share.begin();
    for (int y = rect_.y; y < rect_.br().y; ++y)
      for (int x = rect_.x; x < rect_.br().x; ++x, ++value)
        *value = *value >= kWhole * static_cast<float>(light * vignetteAt(scene_, x, y)) ? 1.0F : 0.0F;
    return share;
  }

  /// Derivative by the grey value of black or white.
  Picture inkDerivative(double black, double white) {
    const Picture before = draw();
    tiles_.setInk(scene_.black + black, scene_.white + white);
    const Picture after = draw();
    tiles_.setInk(scene_.black, scene_.white);
    return difference(after, before, black + white);
  }

 private:
  Picture displaced(double slide, double lateral, double rotation) {
    SyntheticInstrument object = scene_.instruments[instrument_];
    const SyntheticMotion motion = object.motion;
    object.motion.slide = [=](double t) { return motion.slide(t) + slide; };
    object.motion.rotation = [=](double t) { return (motion.rotation ? motion.rotation(t) : 0) + rotation; };
    object.lateral += lateral;
    tiles_.setObject(instrument_, object);
    Picture picture = draw();
    tiles_.setObject(instrument_, scene_.instruments[instrument_]);
    return picture;
  }

  static Picture sum(Picture a, const Picture& b) {
    std::transform(a.begin(), a.end(), b.begin(), a.begin(), std::plus<float>());
    return a;
  }

  static Picture difference(const Picture& a, const Picture& b, double by) {
    Picture result(a.size());
    std::transform(a.begin(), a.end(), b.begin(), result.begin(),
                   [by](float p, float m) { return static_cast<float>((p - m) / by); });
    return result;
  }

  const SyntheticScene& scene_;
  std::size_t instrument_;
  TileRenderer tiles_;
  Exposure exposure_;
  cv::Rect rect_;
};

/// Covariance bound of the parameters with these derivatives. @param mask  1 for pixels that count
Eigen::MatrixXd boundOf(const std::vector<Picture>& derivatives, const Picture& expected, const Picture& mask,
                        const PixelNoise& noise) {
  const auto count = static_cast<Eigen::Index>(derivatives.size());
  Eigen::MatrixXd information = Eigen::MatrixXd::Zero(count, count);
  Eigen::VectorXd gradient(count);
  for (std::size_t i = 0; i < expected.size(); ++i) {
    if (mask[i] == 0 || expected[i] > kSaturated) continue;
    for (Eigen::Index k = 0; k < count; ++k) gradient[k] = derivatives[static_cast<std::size_t>(k)][i];
    information += gradient * gradient.transpose() / (noise.gain * expected[i] + noise.read * noise.read);
  }
  const Eigen::LDLT<Eigen::MatrixXd> solver(information);
  if (solver.info() != Eigen::Success || !(solver.vectorD().minCoeff() > 1e-12 * solver.vectorD().maxCoeff()))
    throw Error("Cramer-Rao bound: too little of the marker is seen in this frame; choose another one.");
  return solver.solve(Eigen::MatrixXd::Identity(count, count));
}

}  // namespace

MarkerBound cramerRaoBound(const SyntheticScene& scene, std::size_t instrument, std::uint64_t index) {
  const SyntheticInstrument& object = scene.instruments.at(instrument);
  const double slide = object.motion.slide(static_cast<double>(index) / scene.rate);
  const double step = kShift / pixelsPerMetre(object.nominal.axis, slide);
  const bool turns = object.tag.cells == 0 && std::holds_alternative<SleeveDesign>(object.nominal.marker);
  ChangedPictures pictures(scene, instrument, index);
  std::vector<Picture> derivatives = {pictures.derivative(step, 0, 0, kShift), pictures.derivative(0, step, 0, kShift),
                                      pictures.inkDerivative(1, 0), pictures.inkDerivative(0, 1)};
  if (turns) derivatives.push_back(pictures.derivative(0, 0, kRotationShift, kRotationShift));
  const Eigen::MatrixXd bound = boundOf(derivatives, pictures.draw(), pictures.mask(), scene.degradation.noise);
  return {std::sqrt(bound(0, 0)), turns ? std::sqrt(bound(4, 4)) : 0};
}

}  // namespace vibe::vision::evidence
