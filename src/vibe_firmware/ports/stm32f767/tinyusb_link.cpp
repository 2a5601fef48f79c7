#include "tinyusb_link.hpp"

#include <tusb.h>
// after it
#include <device/usbd_pvt.h>

#include <algorithm>
#include <cstring>

#include "clocks.hpp"
#include "nucleo_board.hpp"

namespace vibe_firmware::stm32 {
namespace {

constexpr std::uint8_t kDevice = 1, kConfiguration = 2, kString = 3, kReportDescriptor = 0x22;

ControlHandler* handler = nullptr;  // while poll() runs; TinyUSB calls back only then

UsbSetup makeSetup(std::uint8_t type, std::uint8_t request, unsigned value, std::size_t length) {
  UsbSetup setup;
  setup.request_type = type;
  setup.request = request;
  setup.value = static_cast<std::uint16_t>(value);
  setup.length = static_cast<std::uint16_t>(length);
  return setup;
}

// A descriptor in static memory, as TinyUSB wants it; each kind has its own.
template <std::uint8_t type>
const std::uint8_t* descriptor(std::uint8_t request_type, std::uint8_t index) {
  alignas(4) static std::uint8_t bytes[ControlHandler::kMaxData];
  const UsbSetup setup = makeSetup(request_type, 6, type << 8 | index, sizeof bytes);
  return handler->handleControl(setup, nullptr, bytes) > 0 ? bytes : nullptr;
}

// PA11 and PA12, clock, and a session that is valid without a look at VBUS (RM0410, OTG_GCCFG and OTG_GOTGCTL).
void startOtg() {
  configurePin(gpioA(), 11, Mode::Alternate, Pull::None, 10);
  configurePin(gpioA(), 12, Mode::Alternate, Pull::None, 10);
  setField(gpioA().ospeedr, 22, 15, 15);
  setBits(rcc().ahb2enr, bit(7));
  asm volatile("dsb" ::: "memory");
  setField(at<Register>(0x50000038), 21, 1, 0);
  setBits(at<Register>(0x50000000), bit(6) | bit(7));
}

}  // namespace

TinyUsbLink::TinyUsbLink(Diagnostics& diagnostics) {
  diagnostics.write("USB: TinyUSB\r\n");
}

void TinyUsbLink::poll(ControlHandler& control) {
  handler = &control;
  if (!started_) {
    startOtg();
    const tusb_rhport_init_t device = {TUSB_ROLE_DEVICE, TUSB_SPEED_FULL};
    started_ = tusb_init(0, &device);
    enableInterrupt(kUsbInterrupt, 0x40);  // below the tick
  }
  tud_task();
}

bool TinyUsbLink::sendReport(const std::uint8_t* bytes, std::size_t size) {
  return tud_hid_ready() && tud_hid_report(bytes[0], bytes + 1, static_cast<std::uint16_t>(size - 1));
}

}  // namespace vibe_firmware::stm32

using namespace vibe_firmware;
using namespace vibe_firmware::stm32;

extern "C" {

std::uint32_t SystemCoreClock = kCoreClock;  // TinyUSB's driver reads it

void usbHandler() {
  tusb_int_handler(0, true);
}

const std::uint8_t* tud_descriptor_device_cb() {
  return descriptor<kDevice>(0x80, 0);
}

const std::uint8_t* tud_descriptor_configuration_cb(std::uint8_t index) {
  return descriptor<kConfiguration>(0x80, index);
}

const std::uint16_t* tud_descriptor_string_cb(std::uint8_t index, std::uint16_t) {
  return reinterpret_cast<const std::uint16_t*>(descriptor<kString>(0x80, index));
}

const std::uint8_t* tud_hid_descriptor_report_cb(std::uint8_t) {
  return descriptor<kReportDescriptor>(0x81, 0);
}

void tud_mount_cb() {
  handler->handleControl(makeSetup(0x00, 9, 1, 0), nullptr, nullptr);
}

void tud_umount_cb() {
  handler->handleBusReset();
}

void tud_suspend_cb(bool) {
  handler->handleSuspend();
}

// TinyUSB's own driver acknowledges every SET_REPORT before it shows it. This one looks at the report first, so that a
// malformed one stalls (USB 2.0, 8.5.3.4); all else is as there.
bool controlTransfer(std::uint8_t port, std::uint8_t stage, const tusb_control_request_t* request) {
  static std::uint8_t bytes[CFG_TUD_HID_EP_BUFSIZE];
  const bool sets_report = request->bmRequestType == 0x21 && request->bRequest == 9;
  if (!sets_report) return hidd_control_xfer_cb(port, stage, request);
  if (stage == CONTROL_STAGE_SETUP)
    return request->wLength > 0 && request->wLength <= sizeof bytes &&
           tud_control_xfer(port, request, bytes, request->wLength);
  if (stage != CONTROL_STAGE_DATA) return true;
  return handler->handleControl(makeSetup(0x21, 9, request->wValue, request->wLength), bytes, nullptr) >= 0;
}

const usbd_class_driver_t* usbd_app_driver_get_cb(std::uint8_t* count) {
  static usbd_class_driver_t driver{};
  driver.init = hidd_init;
  driver.deinit = hidd_deinit;
  driver.reset = hidd_reset;
  driver.open = hidd_open;
  driver.control_xfer_cb = controlTransfer;
  driver.xfer_cb = hidd_xfer_cb;
  *count = 1;
  return &driver;
}

// TinyUSB takes the report id off what is set and puts it before what is read.
std::uint16_t tud_hid_get_report_cb(std::uint8_t, std::uint8_t id, hid_report_type_t type, std::uint8_t* buffer,
                                    std::uint16_t length) {
  std::uint8_t bytes[ControlHandler::kMaxData];
  const UsbSetup setup = makeSetup(0xA1, 1, static_cast<unsigned>(type) << 8 | id, sizeof bytes);
  const int size = handler->handleControl(setup, nullptr, bytes);
  if (size < 2) return 0;
  const auto content = static_cast<std::uint16_t>(std::min<int>(size - 1, length));
  std::memcpy(buffer, bytes + 1, content);
  return content;
}

// For reports of an OUT endpoint, which the device does not have.
void tud_hid_set_report_cb(std::uint8_t, std::uint8_t, hid_report_type_t, const std::uint8_t*, std::uint16_t) {}
}
