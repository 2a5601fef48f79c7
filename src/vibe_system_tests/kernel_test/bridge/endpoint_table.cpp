#include "endpoint_table.hpp"

#include <cstddef>

namespace vibe::hardware {
namespace {

constexpr std::uint8_t kInterface = 4, kEndpoint = 5;  // descriptor types
constexpr std::size_t kIn = 16;                        // usbredir: endpoints to the host are 16 to 31

std::uint16_t word(const std::uint8_t* bytes) {
  return static_cast<std::uint16_t>(bytes[0] | bytes[1] << 8);
}

void addInterface(const std::uint8_t* bytes, EndpointTable& table) {
  const std::size_t k = table.interfaces.interface_count++;
  table.interfaces.interface[k] = bytes[2];
  table.interfaces.interface_class[k] = bytes[5];
  table.interfaces.interface_subclass[k] = bytes[6];
  table.interfaces.interface_protocol[k] = bytes[7];
}

void addEndpoint(const std::uint8_t* bytes, std::uint8_t interface, EndpointTable& table) {
  const std::size_t k = (bytes[2] & 0x80 ? kIn : 0) + (bytes[2] & 0x0F);
  table.endpoints.type[k] = bytes[3] & 3;
  table.endpoints.interval[k] = bytes[6];
  table.endpoints.interface[k] = interface;
  table.endpoints.max_packet_size[k] = word(bytes + 4);
}

}  // namespace

EndpointTable readEndpoints(const std::vector<std::uint8_t>& configuration) {
  EndpointTable table;
  for (auto& type : table.endpoints.type) type = usb_redir_type_invalid;
  table.endpoints.type[0] = table.endpoints.type[kIn] = usb_redir_type_control;
  table.endpoints.max_packet_size[0] = table.endpoints.max_packet_size[kIn] = 64;
  std::uint8_t interface = 0;
  std::size_t at = 0;
  while (at + 1 < configuration.size()) {
    const std::uint8_t* bytes = &configuration[at];
    const std::size_t size = bytes[0];
    if (size < 2 || at + size > configuration.size()) break;
    if (bytes[1] == kInterface && size >= 9) {
      addInterface(bytes, table);
      interface = bytes[2];
    }
    if (bytes[1] == kEndpoint && size >= 7) addEndpoint(bytes, interface, table);
    at += size;
  }
  return table;
}

usb_redir_device_connect_header readDevice(const std::vector<std::uint8_t>& device) {
  usb_redir_device_connect_header header{};
  header.speed = usb_redir_speed_full;
  header.device_class = device.at(4);
  header.device_subclass = device.at(5);
  header.device_protocol = device.at(6);
  header.vendor_id = word(&device.at(8));
  header.product_id = word(&device.at(10));
  header.device_version_bcd = word(&device.at(12));
  return header;
}

}  // namespace vibe::hardware
