#pragma once
#include <cstdint>

#include "tusb_config.h"

// The part of TinyUSB's interface (0.17 to 0.19) that ports/stm32f767/tinyusb_link.cpp uses, so that it is compiled
// where there is no TinyUSB.

#define OPT_MCU_STM32F7 0
#define OPT_OS_NONE 0
#define OPT_MODE_DEVICE 0
#define OPT_MODE_FULL_SPEED 0

extern "C" {
enum tusb_role_t { TUSB_ROLE_INVALID, TUSB_ROLE_DEVICE };
enum tusb_speed_t { TUSB_SPEED_FULL };
enum hid_report_type_t {
  HID_REPORT_TYPE_INVALID,
  HID_REPORT_TYPE_INPUT,
  HID_REPORT_TYPE_OUTPUT,
  HID_REPORT_TYPE_FEATURE
};
struct tusb_rhport_init_t {
  tusb_role_t role;
  tusb_speed_t speed;
};

bool tusb_init(std::uint8_t rhport, const tusb_rhport_init_t* rh_init);
void tusb_int_handler(std::uint8_t rhport, bool in_isr);
void tud_task();
bool tud_hid_ready();
bool tud_hid_report(std::uint8_t report_id, const void* report, std::uint16_t len);

const std::uint8_t* tud_descriptor_device_cb();
const std::uint8_t* tud_descriptor_configuration_cb(std::uint8_t index);
const std::uint16_t* tud_descriptor_string_cb(std::uint8_t index, std::uint16_t langid);
const std::uint8_t* tud_hid_descriptor_report_cb(std::uint8_t instance);
void tud_mount_cb();
void tud_umount_cb();
void tud_suspend_cb(bool remote_wakeup_en);

struct tusb_control_request_t {
  std::uint8_t bmRequestType, bRequest;
  std::uint16_t wValue, wIndex, wLength;
};
struct tusb_desc_interface_t;
enum xfer_result_t { XFER_RESULT_SUCCESS };
enum { CONTROL_STAGE_SETUP, CONTROL_STAGE_DATA, CONTROL_STAGE_ACK };
bool tud_control_xfer(std::uint8_t rhport, const tusb_control_request_t* request, void* buffer, std::uint16_t len);
void hidd_init();
bool hidd_deinit();
void hidd_reset(std::uint8_t rhport);
std::uint16_t hidd_open(std::uint8_t rhport, const tusb_desc_interface_t* itf_desc, std::uint16_t max_len);
bool hidd_control_xfer_cb(std::uint8_t rhport, std::uint8_t stage, const tusb_control_request_t* request);
bool hidd_xfer_cb(std::uint8_t rhport, std::uint8_t ep_addr, xfer_result_t event, std::uint32_t xferred_bytes);
std::uint16_t tud_hid_get_report_cb(std::uint8_t instance, std::uint8_t report_id, hid_report_type_t report_type,
                                    std::uint8_t* buffer, std::uint16_t reqlen);
void tud_hid_set_report_cb(std::uint8_t instance, std::uint8_t report_id, hid_report_type_t report_type,
                           const std::uint8_t* buffer, std::uint16_t bufsize);
}
