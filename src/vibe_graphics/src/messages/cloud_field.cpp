#include "vibe_graphics/messages/cloud_field.hpp"

namespace vibe::graphics {
namespace {

std::size_t sizeOf(std::uint8_t type) {
  switch (type) {
    case sensor_msgs::PointField::INT8:
    case sensor_msgs::PointField::UINT8:
      return 1;
    case sensor_msgs::PointField::INT16:
    case sensor_msgs::PointField::UINT16:
      return 2;
    case sensor_msgs::PointField::FLOAT64:
      return 8;
    default:
      return 4;
  }
}

}  // namespace

std::string checkLayout(const sensor_msgs::PointCloud2& cloud) {
  if (cloud.is_bigendian) return "The cloud is big-endian, which is not supported.";
  const std::size_t row = std::size_t{cloud.width} * cloud.point_step;
  if (cloud.height > 1 && cloud.row_step != row) return "The cloud has gaps between its rows, which is not supported.";
  if (cloud.data.size() < row * cloud.height)
    return "The cloud is cut short: it has " + std::to_string(cloud.data.size()) + " bytes instead of " +
           std::to_string(row * cloud.height) + ".";
  return {};
}

std::string findField(const sensor_msgs::PointCloud2& cloud, const std::string& name, std::uint8_t type, bool required,
                      CloudField& field) {
  field = {};
  for (const sensor_msgs::PointField& entry : cloud.fields) {
    if (entry.name != name) continue;
    if (entry.datatype != type || entry.count > 1) return "The field '" + name + "' of the cloud has another type.";
    if (std::size_t{entry.offset} + sizeOf(type) > cloud.point_step)
      return "The field '" + name + "' of the cloud lies outside its points.";
    field = CloudField(cloud.data.data() + entry.offset, cloud.point_step);
    return {};
  }
  return required ? "The cloud has no field '" + name + "'; is it tissue/particles?" : std::string();
}

}  // namespace vibe::graphics
