#include "redir_port.hpp"

#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>

#include "endpoint_table.hpp"
#include "unix_socket.hpp"

namespace vibe::hardware {
namespace {

using vibe_firmware::UsbSetup;

constexpr std::uint8_t kDeviceType = 1, kConfigurationType = 2;  // of descriptors
constexpr std::uint8_t kGetDescriptor = 6, kSetConfiguration = 9, kGetReport = 1;
constexpr std::uint8_t kFromDevice = 0x80, kClassFromInterface = 0xA1;
constexpr std::uint8_t kInterruptEndpoint = 0x81;

void report(void*, int level, const char* message) {
  if (level <= usbredirparser_warning) std::fprintf(stderr, "usb_bridge: %s\n", message);
}

/// Of read() and write() in the form that the parser wants: 0: nothing now, -1: closed.
int transferred(ssize_t result) {
  if (result > 0) return static_cast<int>(result);
  return result < 0 && (errno == EAGAIN || errno == EINTR) ? 0 : -1;
}

}  // namespace

/// What the parser calls when a packet of the virtual machine is complete. `self` is the port.
struct RedirPort::Callbacks {
  static RedirPort& port(void* self) { return *static_cast<RedirPort*>(self); }

  static int read(void* self, std::uint8_t* bytes, int size) {
    return transferred(::read(port(self).connection_, bytes, size));
  }

  static int write(void* self, std::uint8_t* bytes, int size) {
    return transferred(::send(port(self).connection_, bytes, size, MSG_NOSIGNAL));
  }

  static void hello(void* self, usb_redir_hello_header*) {
    port(self).greeted_ = true;
    if (port(self).device_) port(self).announce();
  }

  static void reset(void* self) {
    port(self).receiving_ = false;
    if (port(self).device_) port(self).device_->reset();
  }

  static void cancel(void*, std::uint64_t) {}

  static void setConfiguration(void* self, std::uint64_t id, usb_redir_set_configuration_header* header) {
    usb_redir_configuration_status_header status{usb_redir_stall, header->configuration};
    if (port(self).device_) {
      const UsbSetup setup{0, kSetConfiguration, header->configuration, 0, 0};
      if (port(self).device_->control(setup, nullptr, nullptr, 0) >= 0) status.status = usb_redir_success;
    }
    usbredirparser_send_configuration_status(port(self).parser_, id, &status);
  }

  static void setAlternative(void* self, std::uint64_t id, usb_redir_set_alt_setting_header* header) {
    usb_redir_alt_setting_status_header status{usb_redir_success, header->interface, header->alt};
    usbredirparser_send_alt_setting_status(port(self).parser_, id, &status);
  }

  static void startReceiving(void* self, std::uint64_t id, usb_redir_start_interrupt_receiving_header* header) {
    port(self).receiving_ = true;
    usb_redir_interrupt_receiving_status_header status{usb_redir_success, header->endpoint};
    usbredirparser_send_interrupt_receiving_status(port(self).parser_, id, &status);
  }

  static void stopReceiving(void* self, std::uint64_t id, usb_redir_stop_interrupt_receiving_header* header) {
    port(self).receiving_ = false;
    usb_redir_interrupt_receiving_status_header status{usb_redir_success, header->endpoint};
    usbredirparser_send_interrupt_receiving_status(port(self).parser_, id, &status);
  }

  static void control(void* self, std::uint64_t id, usb_redir_control_packet_header* header, std::uint8_t* data, int) {
    port(self).answer(id, *header, data);
    if (data) usbredirparser_free_packet_data(port(self).parser_, data);
  }

  static usbredirparser* makeParser(RedirPort& port);
};

usbredirparser* RedirPort::Callbacks::makeParser(RedirPort& port) {
  usbredirparser* parser = usbredirparser_create();
  parser->priv = &port;
  parser->log_func = report;
  parser->read_func = read;
  parser->write_func = write;
  parser->hello_func = hello;
  parser->reset_func = reset;
  parser->cancel_data_packet_func = cancel;
  parser->set_configuration_func = setConfiguration;
  parser->set_alt_setting_func = setAlternative;
  parser->start_interrupt_receiving_func = startReceiving;
  parser->stop_interrupt_receiving_func = stopReceiving;
  parser->control_packet_func = control;
  std::uint32_t capabilities[USB_REDIR_CAPS_SIZE] = {};
  // an xHCI of QEMU accepts only peers with the last three
  for (const int capability : {usb_redir_cap_connect_device_version, usb_redir_cap_ep_info_max_packet_size,
                               usb_redir_cap_64bits_ids, usb_redir_cap_32bits_bulk_length}) {
    usbredirparser_caps_set_cap(capabilities, capability);
  }
  usbredirparser_init(parser, "vibe usb_bridge", capabilities, USB_REDIR_CAPS_SIZE, usbredirparser_fl_usb_host);
  return parser;
}

RedirPort::RedirPort(const std::string& socket_path) : listener_(listenAt(socket_path)) {}

RedirPort::~RedirPort() {
  if (parser_) usbredirparser_destroy(parser_);
  if (connection_ >= 0) close(connection_);
  close(listener_);
}

void RedirPort::plug(std::unique_ptr<UsbDevice> device) {
  device_ = std::move(device);
  receiving_ = false;
  if (greeted_) announce();
}

void RedirPort::unplug() {
  device_.reset();
  receiving_ = false;
  if (!greeted_) return;
  usbredirparser_send_device_disconnect(parser_);
  flush();
}

std::array<int, 2> RedirPort::descriptors() const {
  return {connection_ >= 0 ? connection_ : listener_, device_ ? device_->descriptor() : -1};
}

bool RedirPort::service() {
  if (connection_ < 0) {
    connection_ = acceptFrom(listener_);
    if (connection_ < 0) return true;
    parser_ = Callbacks::makeParser(*this);
    flush();
  }
  if (usbredirparser_do_read(parser_) == usbredirparser_read_io_error) return false;
  if (device_) device_->service([this](const std::uint8_t* bytes, std::size_t size) { sendReport(bytes, size); });
  flush();
  return true;
}

void RedirPort::flush() {
  // what the socket does not take now is tried again by the next service()
  while (parser_ && usbredirparser_has_data_to_write(parser_) && usbredirparser_do_write(parser_) == 0) {
  }
}

std::vector<std::uint8_t> RedirPort::askDescriptor(std::uint8_t type) {
  std::vector<std::uint8_t> bytes(255);
  const UsbSetup setup{kFromDevice, kGetDescriptor, static_cast<std::uint16_t>(type << 8), 0, 255};
  const int size = device_->control(setup, nullptr, bytes.data(), bytes.size());
  bytes.resize(size < 0 ? 0 : size);
  return bytes;
}

void RedirPort::announce() {
  EndpointTable table = readEndpoints(askDescriptor(kConfigurationType));
  usb_redir_device_connect_header device = readDevice(askDescriptor(kDeviceType));
  usbredirparser_send_interface_info(parser_, &table.interfaces);
  usbredirparser_send_ep_info(parser_, &table.endpoints);
  usbredirparser_send_device_connect(parser_, &device);
  flush();
}

void RedirPort::sendReport(const std::uint8_t* bytes, std::size_t size) {
  if (!receiving_) return;
  if (faults_.reports_to_lose > 0) {
    --faults_.reports_to_lose;
    return;
  }
  send(bytes, size);
  if (faults_.reports_to_repeat > 0) {
    --faults_.reports_to_repeat;
    send(bytes, size);
  }
}

void RedirPort::send(const std::uint8_t* bytes, std::size_t size) {
  usb_redir_interrupt_packet_header header{kInterruptEndpoint, usb_redir_success, static_cast<std::uint16_t>(size)};
  usbredirparser_send_interrupt_packet(parser_, 0, &header, const_cast<std::uint8_t*>(bytes), static_cast<int>(size));
}

void RedirPort::answer(std::uint64_t id, usb_redir_control_packet_header header, const std::uint8_t* data) {
  const UsbSetup setup{header.requesttype, header.request, header.value, header.index, header.length};
  std::vector<std::uint8_t> response(setup.length);
  const int size = device_ ? device_->control(setup, data, response.data(), response.size()) : -1;
  if (size > 1 && setup.request_type == kClassFromInterface && setup.request == kGetReport &&
      faults_.answers_to_corrupt > 0) {
    --faults_.answers_to_corrupt;
    response[size - 1] ^= 1;
  }
  header.status = size < 0 ? usb_redir_stall : usb_redir_success;
  const bool from_device = setup.request_type & kFromDevice;
  if (from_device) header.length = static_cast<std::uint16_t>(size < 0 ? 0 : size);
  const int sent = from_device ? header.length : 0;
  usbredirparser_send_control_packet(parser_, id, &header, sent ? response.data() : nullptr, sent);
}

}  // namespace vibe::hardware
