#pragma once
#include "tusb.h"

extern "C" {
struct usbd_class_driver_t {
  const char* name;
  void (*init)();
  bool (*deinit)();
  void (*reset)(std::uint8_t rhport);
  std::uint16_t (*open)(std::uint8_t rhport, const tusb_desc_interface_t* desc_intf, std::uint16_t max_len);
  bool (*control_xfer_cb)(std::uint8_t rhport, std::uint8_t stage, const tusb_control_request_t* request);
  bool (*xfer_cb)(std::uint8_t rhport, std::uint8_t ep_addr, xfer_result_t result, std::uint32_t xferred_bytes);
  void (*sof)(std::uint8_t rhport, std::uint32_t frame_count);
};

const usbd_class_driver_t* usbd_app_driver_get_cb(std::uint8_t* driver_count);
}
