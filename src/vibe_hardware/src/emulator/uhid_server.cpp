#include "vibe_hardware/emulator/uhid_server.hpp"

#include <fcntl.h>
#include <linux/input.h>
#include <linux/uhid.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <stdexcept>

namespace vibe::hardware {
namespace {

constexpr const char* kPath = "/dev/uhid";
constexpr int kMaxEventsPerServe = 16;

template <std::size_t size>
void copyText(const std::string& text, __u8 (&field)[size]) {
  std::memcpy(field, text.data(), std::min(text.size(), size - 1));
}

}  // namespace

UhidServer::UhidServer(UsbHost& device) : device_(device), file_(::open(kPath, O_RDWR | O_NONBLOCK | O_CLOEXEC)) {
  if (!file_)
    throw std::runtime_error(std::string(kPath) + " cannot be opened (" + std::strerror(errno) +
                             "); load the kernel module uhid, and give your user write access to the file.");
  create();
}

UhidServer::~UhidServer() {
  uhid_event event{};
  event.type = UHID_DESTROY;
  writeEvent(&event);
}

bool UhidServer::writeEvent(const void* event) {
  return ::write(file_.get(), event, sizeof(uhid_event)) == static_cast<ssize_t>(sizeof(uhid_event));
}

void UhidServer::create() {
  uhid_event event{};
  event.type = UHID_CREATE2;
  uhid_create2_req& request = event.u.create2;
  copyText(device_.name(), request.name);
  copyText(device_.serial(), request.uniq);
  request.bus = BUS_USB;
  request.vendor = device_.vendor();
  request.product = device_.product();
  const std::vector<std::uint8_t>& descriptor = device_.reportDescriptor();
  request.rd_size = static_cast<__u16>(descriptor.size());
  std::copy(descriptor.begin(), descriptor.end(), request.rd_data);
  if (!writeEvent(&event))
    throw std::runtime_error(std::string(kPath) + " does not take the device (" + std::strerror(errno) +
                             "); look for the reason in the kernel log.");
}

void UhidServer::publish(const std::uint8_t* report, std::size_t size) {
  uhid_event event{};
  event.type = UHID_INPUT2;
  event.u.input2.size = static_cast<__u16>(size);
  std::copy_n(report, size, event.u.input2.data);
  dropped_ += writeEvent(&event) ? 0 : 1;
}

void UhidServer::serve() {
  for (int i = 0; i < kMaxEventsPerServe; ++i) {
    uhid_event event{}, reply{};
    if (::read(file_.get(), &event, sizeof event) <= 0) return;
    if (event.type == UHID_GET_REPORT) {
      const std::vector<std::uint8_t> report = event.u.get_report.rtype == UHID_FEATURE_REPORT
                                                   ? device_.getFeature(event.u.get_report.rnum)
                                                   : std::vector<std::uint8_t>();
      reply.type = UHID_GET_REPORT_REPLY;
      reply.u.get_report_reply.id = event.u.get_report.id;
      reply.u.get_report_reply.err = report.empty() ? EIO : 0;
      reply.u.get_report_reply.size = static_cast<__u16>(report.size());
      std::copy(report.begin(), report.end(), reply.u.get_report_reply.data);
    } else if (event.type == UHID_SET_REPORT) {
      const uhid_set_report_req& request = event.u.set_report;
      const bool taken = request.rtype == UHID_FEATURE_REPORT && device_.setFeature(request.data, request.size);
      reply.type = UHID_SET_REPORT_REPLY;
      reply.u.set_report_reply.id = request.id;
      reply.u.set_report_reply.err = taken ? 0 : EIO;
    } else {
      continue;  // opened, closed, started
    }
    writeEvent(&reply);
  }
}

}  // namespace vibe::hardware
