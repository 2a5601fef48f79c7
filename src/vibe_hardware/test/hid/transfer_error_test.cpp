#include "hid/transport.hpp"

#include <gtest/gtest.h>

#include <cerrno>

#include "vibe_hardware/hid/hid_port.hpp"

namespace vibe::hardware::transfer_error_test {
namespace {

TEST(TransferError, ATimeoutIsNoAnswerAndNoRejection) {
  EXPECT_THROW(failTransfer("/dev/hidraw0", ETIMEDOUT, "feature report 3 cannot be read"), NoAnswer);
}

TEST(TransferError, AStallIsARejection) {
  for (const int error : {EPIPE, EINVAL, EOVERFLOW}) EXPECT_THROW(failTransfer("p", error, "w"), ReportRejected);
}

TEST(TransferError, EverythingElseMeansThatTheDeviceIsGone) {
  for (const int error : {ENODEV, EIO, ESHUTDOWN}) EXPECT_THROW(failTransfer("p", error, "w"), DeviceGone);
}

TEST(TransferError, NamesDeviceReportAndReason) {
  try {
    failTransfer("/dev/hidraw0", ETIMEDOUT, "feature report 3 cannot be read");
  } catch (const NoAnswer& error) {
    EXPECT_STREQ(error.what(), "/dev/hidraw0: feature report 3 cannot be read: Connection timed out");
  }
}

}  // namespace
}  // namespace vibe::hardware::transfer_error_test
