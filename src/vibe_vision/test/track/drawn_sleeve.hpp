#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>
#include <vector>

#include "vibe_vision/track/marker_pattern.hpp"

namespace vibe::vision {

/// The picture of a sleeve by brute force: rays of a pinhole camera through a fine grid of points, each met with the
/// cylinder, then summed with the weights of optics, pixel and motion. It shares nothing with SleevePattern.
class DrawnSleeve {
 public:
  static constexpr int kAcross = 12, kAlong = 48;  ///< points per pixel

  DrawnSleeve(const SleeveDesign& design, double pixels_per_metre, const MarkerView& view, const MarkerPose& pose,
              const MarkerMotion& motion)
      : design_(design), pixels_per_metre_(pixels_per_metre), focal_(view.focal_length), pose_(pose) {
    const Eigen::Rotation2Dd turn(pose.tilt);
    const Eigen::Vector2d u = turn * Eigen::Vector2d(std::cos(pose.slant), 0);
    along_ = {u.x(), u.y(), std::sin(pose.slant)};
    principal_ = {view.principal_along, view.principal_lateral};
    centre_ = {pose.along - principal_.x(), pose.lateral - principal_.y(), focal_};
    facing_ = -(centre_ - centre_.dot(along_) * along_).normalized();
    across_ = along_.cross(facing_);
    makeWeights(motion);
  }

  /// At a pixel relative to SlideAxis::origin.
  double at(double x, double y) const {
    double sum = 0;
    for (std::size_t j = 0; j < across_weights_.size(); ++j) {
      const double dy = (static_cast<double>(j) + 0.5) / kAcross - across_reach_;
      const double shift = std::fmod(static_cast<double>(j) * 0.6180339887, 1.0);  // no grid that edges could follow
      double line = 0;
      for (std::size_t i = 0; i < along_weights_.size(); ++i)
        line += along_weights_[i] * point(x + (static_cast<double>(i) + shift) / kAlong - along_reach_, y + dy);
      sum += across_weights_[j] * line;
    }
    return sum;
  }

 private:
  /// Reflectance of what a ray sees.
  double point(double x, double y) const {
    const Eigen::Vector3d ray = Eigen::Vector3d(x - principal_.x(), y - principal_.y(), focal_).normalized();
    const double radius = design_.diameter / 2 * pixels_per_metre_ * std::exp(pose_.log_scale);
    const Eigen::Vector3d r = ray - ray.dot(along_) * along_, c = centre_ - centre_.dot(along_) * along_;
    const double a = r.dot(r), b = r.dot(c), q = b * b - a * (c.dot(c) - radius * radius);
    if (q < 0) return 0.4;  // beside the rod
    const Eigen::Vector3d p = ray * ((b - std::sqrt(q)) / a) - centre_;
    const double phi = std::atan2(p.dot(across_), p.dot(facing_));
    const double u = p.dot(along_) / (pixels_per_metre_ * std::exp(pose_.log_scale));
    return std::abs(u) > design_.length / 2 ? 0.4 : reflectance(design_, u, phi - pose_.rotation);
  }

  static double step(double x, double blur) { return 0.5 * std::erfc(-x / blur * M_SQRT1_2); }

  void makeWeights(const MarkerMotion& motion) {
    const double reach = 4.5 * pose_.blur + 0.5;
    across_reach_ = reach;
    along_reach_ = reach + std::abs(motion.length) / 2 + 2 * std::abs(motion.bend);
    across_weights_.resize(static_cast<std::size_t>(2 * across_reach_ * kAcross));
    along_weights_.resize(static_cast<std::size_t>(2 * along_reach_ * kAlong));
    double sum = 0;
    for (std::size_t j = 0; j < across_weights_.size(); ++j) {
      const double d = (static_cast<double>(j) + 0.5) / kAcross - across_reach_;
      across_weights_[j] = step(d + 0.5, pose_.blur) - step(d - 0.5, pose_.blur);
      sum += across_weights_[j];
    }
    for (double& weight : across_weights_) weight /= sum;
    sum = 0;
    for (std::size_t i = 0; i < along_weights_.size(); ++i) {
      const double d = (static_cast<double>(i) + 0.5) / kAlong - along_reach_;
      for (int k = 0; k < 50; ++k) {
        const double time = (k + 0.5) / 50 - 0.5;  // of the exposure
        const double m = d + motion.length * time + motion.bend * (8 * time * time - 2.0 / 3);
        along_weights_[i] += step(m + 0.5, pose_.blur) - step(m - 0.5, pose_.blur);
      }
      sum += along_weights_[i];
    }
    for (double& weight : along_weights_) weight /= sum;
  }

  SleeveDesign design_;
  double pixels_per_metre_, focal_;
  Eigen::Vector2d principal_;
  MarkerPose pose_;
  Eigen::Vector3d along_, centre_, facing_, across_;
  double across_reach_ = 0, along_reach_ = 0;
  std::vector<double> across_weights_, along_weights_;
};

}  // namespace vibe::vision
