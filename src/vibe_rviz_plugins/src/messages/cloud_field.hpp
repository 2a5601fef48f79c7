#pragma once
#include <sensor_msgs/PointCloud2.h>

#include <cstring>
#include <string>

namespace vibe {

/// One field of a point cloud, found by name: the value of point i is at(i). Valid as long as the message is.
class CloudField {
 public:
  CloudField() = default;
  CloudField(const std::uint8_t* first, std::size_t stride) : first_(first), stride_(stride) {}

  bool present() const { return first_ != nullptr; }
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

/// Empty if the cloud's sizes agree with its data and its byte order is this machine's, else what is wrong.
std::string checkLayout(const sensor_msgs::PointCloud2& cloud);

/// Finds a field of this type (sensor_msgs/PointField). Empty if it is there, or is not and need not be; else what is
/// wrong. The layout has been checked.
std::string findField(const sensor_msgs::PointCloud2& cloud, const std::string& name, std::uint8_t type, bool required,
                      CloudField& field);

}  // namespace vibe
