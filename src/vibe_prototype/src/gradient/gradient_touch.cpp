#include "gradient/gradient_touch.hpp"

#include <algorithm>

namespace vibe::prototype {

namespace {

constexpr int kRounds = 4;  // each may bring further particles into the tool

}  // namespace

/// Holds the touched particles that are not held yet; returns whether there were any.
bool GradientTouch::takeNew() {
  const std::size_t before = handles_.size();
  for (const Touch& touch : found_) {
    if (std::find(handles_.begin(), handles_.end(), touch.particle) != handles_.end()) continue;
    handles_.push_back(touch.particle);
    targets_.push_back(touch.target);
  }
  return handles_.size() > before;
}

bool GradientTouch::sameBase(const SurfaceView& base) const {
  return base_x_ == base.x && base_y_ == base.y && base_z_ == base.z;
}

void GradientTouch::deform(const SurfaceView& base) {
  if (deformation_ == nullptr || made_for_ != handles_ || !sameBase(base)) {
    deformation_ = std::make_unique<GradientDeformation>(base, patchAround(base, handles_, radius_), handles_, turns_);
    made_for_ = handles_;
    base_x_ = base.x, base_y_ = base.y, base_z_ = base.z;
  }
  deformation_->deform(targets_, positions_);
}

int GradientTouch::update(const SurfaceView& base, const FindTouches& find, std::vector<double>& x,
                          std::vector<double>& y, std::vector<double>& z) {
  x = base.x, y = base.y, z = base.z;
  handles_.clear();
  targets_.clear();
  for (int round = 0; round < kRounds; ++round) {
    found_.clear();
    find(x, y, z, found_);
    if (!takeNew()) break;
    deform(base);
    x = base.x, y = base.y, z = base.z;
    for (std::size_t i = 0; i < positions_.size(); ++i) {
      const int node = deformation_->patch()[i];
      x[node] = positions_[i].x(), y[node] = positions_[i].y(), z[node] = positions_[i].z();
    }
  }
  return static_cast<int>(handles_.size());
}

}  // namespace vibe::prototype
