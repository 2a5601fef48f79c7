#pragma once

#include <cstring>
#include <string>

#include <sensor_msgs/PointCloud2.h>

namespace vibe::graphics {

/// A position beyond it is a mistake [m]. Graphics libraries abort on bounding boxes that are not finite.
constexpr double kMaxCoordinate = 1e6;

/// One field of a point cloud: at(i) is the value of point i. Valid as long as the message.
class CloudField {
 public:
  CloudField() = default;
  /// Of point 0, and bytes from point to point.
  CloudField(const std::uint8_t* first, std::size_t stride) : first_(first), stride_(stride) {}

  bool present() const { return first_ != nullptr; }  ///< the cloud has this field
  /// @tparam T  type of the field, trivially copyable; not checked. Only if the field is present, and for points of the
  /// cloud.
  template <class T>
  T at(std::size_t i) const {
    T value;
    std::memcpy(&value, first_ + i * stride_, sizeof value);
    return value;
  }

 private:
  const std::uint8_t* first_ = nullptr;
  std::size_t stride_ = 0;
};

/// Checks sizes and byte order of a cloud.
/// @return empty; otherwise one sentence that says what is wrong
std::string checkLayout(const sensor_msgs::PointCloud2& cloud);

/// Finds a field of this type (sensor_msgs/PointField) in a cloud whose layout has been checked.
/// @return empty, also if an optional field is absent; otherwise one sentence that says what is wrong
std::string findField(const sensor_msgs::PointCloud2& cloud, const std::string& name, std::uint8_t type, bool required,
                      CloudField& field);

}  // namespace vibe::graphics
