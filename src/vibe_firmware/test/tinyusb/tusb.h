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
std::uint16_t tud_hid_get_report_cb(std::uint8_t instance, std::uint8_t report_id, hid_report_type_t report_type,
                                    std::uint8_t* buffer, std::uint16_t reqlen);
void tud_hid_set_report_cb(std::uint8_t instance, std::uint8_t report_id, hid_report_type_t report_type,
                           const std::uint8_t* buffer, std::uint16_t bufsize);
}
