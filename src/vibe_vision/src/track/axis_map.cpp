#include "track/axis_map.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace vibe::vision {
namespace {

constexpr std::uint8_t kSaturated = 253;  // grey values from which a pixel may have lost light [DN]
constexpr int kHalo = 5;                  // pixels around the middle of a highlight that show its light too

}  // namespace

AxisMap::AxisMap(const CameraModel& camera, const SlideAxis& axis, double begin, double end, double half_width)
    : camera_(camera), axis_(axis), across_(acrossOf(axis)) {
  const std::vector<Eigen::Vector2d> outline = border(begin, end, half_width);
  double top = 1e9, bottom = -1e9;
  for (const Eigen::Vector2d& p : outline) top = std::min(top, p.y()), bottom = std::max(bottom, p.y());
  first_row_ = static_cast<int>(std::floor(top));
  for (int y = first_row_; y <= static_cast<int>(std::ceil(bottom)); ++y) addRow(y, outline);
  const auto side = static_cast<std::size_t>(3 * half_width);
  saturated_.assign(side * side, 0);
}

Eigen::Vector2d AxisMap::pixel(double along, double lateral) const {
  return distort(camera_, pixelAt(axis_, along, lateral));
}

/// Points around the band, less than 1 px apart; what is far outside of the sensor is drawn to its edge.
std::vector<Eigen::Vector2d> AxisMap::border(double begin, double end, double half_width) const {
  std::vector<Eigen::Vector2d> points;
  const double room = half_width + 8;
  const auto add = [&](double along, double lateral) {
    const Eigen::Vector2d p = pixel(along, lateral);
    if (p.allFinite())
      points.emplace_back(std::clamp(p.x(), -room, camera_.width + room),
                          std::clamp(p.y(), -room, camera_.height + room));
  };
  const int along_steps = static_cast<int>(std::ceil((end - begin) * 2)) + 1;
  const int lateral_steps = static_cast<int>(std::ceil(half_width * 4)) + 1;
  for (int i = 0; i <= along_steps; ++i)
    for (double side : {-half_width, half_width}) add(begin + (end - begin) * i / along_steps, side);
  for (int i = 0; i <= lateral_steps; ++i)
    for (double place : {begin, end}) add(place, half_width * (2.0 * i / lateral_steps - 1));
  return points;
}

void AxisMap::addRow(int y, const std::vector<Eigen::Vector2d>& border) {
  double left = 1e9, right = -1e9;
  for (const Eigen::Vector2d& p : border)
    if (std::abs(p.y() - y) <= 1) left = std::min(left, p.x()), right = std::max(right, p.x());
  Row row;
  row.first = along_.size();
  if (left <= right) row.begin = static_cast<int>(std::floor(left)), row.end = static_cast<int>(std::ceil(right)) + 1;
  for (int x = row.begin; x < row.end; ++x) {
    const Eigen::Vector2d p = undistort(camera_, Eigen::Vector2d(x, y)) - axis_.origin;
    along_.push_back(static_cast<float>(p.dot(axis_.direction)));
    lateral_.push_back(static_cast<float>(p.dot(across_)));
  }
  rows_.push_back(row);
}

cv::Rect AxisMap::boundsOf(const Eigen::Vector2d& centre, const Eigen::Vector2d& half_extents) const {
  Eigen::Vector2d low = Eigen::Vector2d::Constant(1e9), high = -low;
  for (double a : {-1.0, 0.0, 1.0})
    for (double b : {-1.0, 0.0, 1.0}) {
      const Eigen::Vector2d p = pixel(centre.x() + a * half_extents.x(), centre.y() + b * half_extents.y());
      if (!p.allFinite()) continue;
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
    }
  if (!(low.array() <= high.array()).all()) return {};
  const auto limit = [](double v) { return static_cast<int>(std::clamp(v, -1e6, 1e6)); };
  const int x = limit(std::floor(low.x())), y = limit(std::floor(low.y()));
  return {x, y, limit(std::ceil(high.x())) - x + 1, limit(std::ceil(high.y())) - y + 1};
}

cv::Rect AxisMap::gather(const Frame& frame, const Eigen::Vector2d& centre, const Eigen::Vector2d& half_extents,
                         PixelBlock& pixels) {
  cv::Rect rect = boundsOf(centre, half_extents);
  const int last_row = first_row_ + static_cast<int>(rows_.size());
  const int top = std::max(rect.y, first_row_), bottom = std::min(rect.y + rect.height, last_row);
  rect.y = top, rect.height = std::max(bottom - top, 0);
  pixels.count = 0;
  markSaturated(frame, rect);
  for (int part = 0; part < 4; ++part)
    for (int y = rect.y + ((rect.y + part) & 1); y < rect.y + rect.height; y += 2)
      gatherRow(frame, rect, y, part / 2, centre, half_extents, pixels);
  pixels.pad();
  return rect;
}

/// Marks what is near highlights in saturated_; nearly always there is none. Single saturated pixels are noise of a
/// bright picture: a highlight saturates a pixel and its four neighbours.
void AxisMap::markSaturated(const Frame& frame, const cv::Rect& rect) {
  any_saturated_ = false;
  const ImageView& image = frame.image;
  const int left = std::max(rect.x - frame.offset_x, 1), top = std::max(rect.y - frame.offset_y, 1);
  const int right = std::min(rect.x - frame.offset_x + rect.width, image.width - 1);
  const int bottom = std::min(rect.y - frame.offset_y + rect.height, image.height - 1);
  for (int y = top; y < bottom; ++y) {
    const std::uint8_t *above = image.row(y - 1), *row = image.row(y), *below = image.row(y + 1);
    std::uint8_t highest = 0;
    for (int x = left; x < right; ++x) highest = std::max(highest, row[x]);
    if (highest < kSaturated) continue;
    for (int x = left; x < right; ++x) {
      const std::uint8_t least = std::min({row[x], row[x - 1], row[x + 1], above[x], below[x]});
      if (least >= kSaturated) markHalo(rect, x + frame.offset_x, y + frame.offset_y);
    }
  }
}

void AxisMap::markHalo(const cv::Rect& rect, int x, int y) {
  const auto size = static_cast<std::size_t>(rect.width) * rect.height;
  if (!any_saturated_) saturated_.assign(std::max(size, saturated_.size()), 0);
  any_saturated_ = true;
  for (int j = std::max(rect.y, y - kHalo); j < std::min(rect.y + rect.height, y + kHalo + 1); ++j) {
    const int reach = static_cast<int>(std::sqrt(static_cast<double>(kHalo * kHalo - (j - y) * (j - y))));
    const int from = std::max(rect.x, x - reach), to = std::min(rect.x + rect.width, x + reach + 1);
    if (from < to)
      std::memset(saturated_.data() + static_cast<std::ptrdiff_t>(j - rect.y) * rect.width + (from - rect.x), 1,
                  static_cast<std::size_t>(to - from));
  }
}

void AxisMap::gatherRow(const Frame& frame, const cv::Rect& rect, int y, int parity, const Eigen::Vector2d& centre,
                        const Eigen::Vector2d& half_extents, PixelBlock& pixels) const {
  const Row& row = rows_[y - first_row_];
  int begin = std::max(rect.x, row.begin);
  const int end = std::min(rect.x + rect.width, row.end);
  begin += (begin + y + parity) & 1;
  const auto centre_x = static_cast<float>(centre.x()), centre_y = static_cast<float>(centre.y());
  const auto reach_x = static_cast<float>(half_extents.x()), reach_y = static_cast<float>(half_extents.y());
  const int v = y - frame.offset_y;
  const bool in_frame = v >= 0 && v < frame.image.height;
  const std::uint8_t* values = in_frame ? frame.image.row(v) : nullptr;
  const std::uint8_t* dead =
      any_saturated_ ? saturated_.data() + static_cast<std::ptrdiff_t>(y - rect.y) * rect.width : nullptr;
  const float *along = along_.data() + row.first - row.begin, *lateral = lateral_.data() + row.first - row.begin;
  const auto within = [&](int x) {
    return std::abs(along[x] - centre_x) <= reach_x && std::abs(lateral[x] - centre_y) <= reach_y;
  };
  while (begin < end && !within(begin)) begin += 2;  // what is within is one piece of the row
  int last = begin + (end - 1 - begin) / 2 * 2;
  while (last > begin && !within(last)) last -= 2;
  if (begin >= end) return;
  const int room = static_cast<int>(pixels.capacity() - pixels.count), count = std::min((last - begin) / 2 + 1, room);
  float *px = pixels.along.data() + pixels.count, *py = pixels.lateral.data() + pixels.count;
  float *value = pixels.value.data() + pixels.count, *weight = pixels.weight.data() + pixels.count;
  pixels.count += static_cast<std::size_t>(count);
  for (int i = 0; i < count; ++i) px[i] = along[begin + 2 * i], py[i] = lateral[begin + 2 * i];
  if (in_frame && dead == nullptr && begin >= frame.offset_x && last < frame.offset_x + frame.image.width) {
    const std::uint8_t* seen = values + (begin - frame.offset_x);
    for (int i = 0; i < count; ++i) value[i] = static_cast<float>(seen[2 * i]), weight[i] = 1;
    return;
  }
  for (int i = 0; i < count; ++i) {
    const int x = begin + 2 * i, u = x - frame.offset_x;
    const bool seen = in_frame && u >= 0 && u < frame.image.width;
    value[i] = seen ? static_cast<float>(values[u]) : 0;
    weight[i] = seen && (dead == nullptr || dead[x - rect.x] == 0) ? 1.F : 0.F;
  }
}

void AxisMap::readBand(const Frame& frame, double begin, double end, double half_width, AxisProfile& profile) const {
  std::fill(profile.sum.begin(), profile.sum.end(), 0.F);
  std::fill(profile.count.begin(), profile.count.end(), 0.F);
  profile.pixels = profile.saturated = 0;
  const cv::Rect rect = boundsOf({(begin + end) / 2, 0}, {(end - begin) / 2, half_width});
  const auto first = static_cast<float>(profile.first - 0.5), width = static_cast<float>(half_width);
  const float low = std::max(static_cast<float>(begin) - first, 0.F);
  const float high = std::min(static_cast<float>(end) - first, static_cast<float>(profile.sum.size()));
  float *sum = profile.sum.data(), *count = profile.count.data();
  const int top = std::max({rect.y, first_row_, frame.offset_y});
  const int bottom = std::min(
      {rect.y + rect.height, first_row_ + static_cast<int>(rows_.size()), frame.offset_y + frame.image.height});
  for (int y = top; y < bottom; ++y) {
    const Row& row = rows_[y - first_row_];
    const std::uint8_t* values = frame.image.row(y - frame.offset_y);
    const int from = std::max({rect.x, row.begin, frame.offset_x});
    const int to = std::min({rect.x + rect.width, row.end, frame.offset_x + frame.image.width});
    const float *along = along_.data() + row.first - row.begin, *lateral = lateral_.data() + row.first - row.begin;
    for (int x = from; x < to; ++x) {
      const float bin = along[x] - first;
      if (!(bin >= low && bin < high && std::abs(lateral[x]) <= width)) continue;
      const std::uint8_t value = values[x - frame.offset_x];
      const int i = static_cast<int>(bin);
      sum[i] += static_cast<float>(value);
      count[i] += 1;
      if (value >= kSaturated) ++profile.saturated;
    }
  }
  for (const float n : profile.count) profile.pixels += static_cast<int>(n);
}

}  // namespace vibe::vision
