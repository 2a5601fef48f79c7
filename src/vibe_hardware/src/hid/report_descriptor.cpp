#include "vibe_hardware/hid/report_descriptor.hpp"

#include <map>
#include <string>
#include <utility>

#include "vibe_core/program/error.hpp"
#include "vibe_firmware/protocol/descriptors.hpp"

namespace vibe::hardware {
namespace {

using Kind = ReportSize::Kind;

constexpr std::size_t kMaxReportBits = 8 * 4096;
constexpr std::size_t kMaxStack = 16;
constexpr int kMaxDepth = 32;
constexpr std::uint8_t kLongItem = 0xFE;

// prefix of a short item without its size, HID 1.11, sections 6.2.2.4 to 6.2.2.8
enum Item : std::uint8_t {
  kInputItem = 0x80,
  kOutputItem = 0x90,
  kFeatureItem = 0xB0,
  kCollection = 0xA0,
  kEndCollection = 0xC0,
  kUsagePage = 0x04,
  kReportSize = 0x74,
  kReportId = 0x84,
  kReportCount = 0x94,
  kPush = 0xA4,
  kPop = 0xB4,
  kUsage = 0x08,
};

constexpr std::uint32_t kApplication = 1;

class Parser {
 public:
  Parser(const std::uint8_t* bytes, std::size_t size) : bytes_(bytes), size_(size) {}

  ReportLayout parse() {
    if (size_ == 0) throw Error("The report descriptor is empty; check the firmware of the device.");
    if (size_ > kMaxReportDescriptor) {
      throw Error("The report descriptor has " + std::to_string(size_) + " bytes, more than " +
                  std::to_string(kMaxReportDescriptor) + "; check the firmware of the device.");
    }
    while (at_ < size_) takeItem();
    if (depth_ != 0) fail("ends inside a collection");
    return finish();
  }

 private:
  struct Globals {
    std::uint32_t usage_page = 0, report_size = 0, report_count = 0;
    std::uint8_t report_id = 0;
  };

  const std::uint8_t* bytes_;
  std::size_t size_;
  std::size_t at_ = 0;    // next byte
  std::size_t item_ = 0;  // first byte of the present item
  int depth_ = 0;
  bool has_application_ = false;
  std::uint32_t usage_ = 0;
  Globals globals_;
  std::vector<Globals> stack_;
  std::map<std::pair<Kind, std::uint8_t>, std::size_t> bits_;
  ReportLayout layout_;

  [[noreturn]] void fail(const std::string& what) const {
    throw Error("The report descriptor " + what + " at byte " + std::to_string(item_) +
                "; check the firmware of the device.");
  }

  void takeItem() {
    item_ = at_;
    const std::uint8_t prefix = bytes_[at_++];
    if (prefix == kLongItem) return skipLongItem();
    const std::size_t length = (prefix & 3) == 3 ? 4 : prefix & 3;
    if (length > size_ - at_) fail("ends inside an item");
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < length; ++i) value |= static_cast<std::uint32_t>(bytes_[at_ + i]) << (8 * i);
    at_ += length;
    apply(prefix & 0xFC, value, length);
  }

  void skipLongItem() {
    if (at_ == size_ || bytes_[at_] + 2U > size_ - at_) fail("ends inside a long item");
    at_ += bytes_[at_] + 2U;
  }

  void apply(int item, std::uint32_t value, std::size_t length) {
    switch (item) {
      case kInputItem:
        return addField(Kind::Input);
      case kOutputItem:
        return addField(Kind::Output);
      case kFeatureItem:
        return addField(Kind::Feature);
      case kCollection:
        return openCollection(value);
      case kEndCollection:
        usage_ = 0;
        if (--depth_ < 0) fail("ends a collection that was not begun");
        return;
      case kUsage:
        usage_ = length == 4 ? value : (globals_.usage_page << 16) | value;
        return;
      default:
        return applyGlobal(item, value);
    }
  }

  void applyGlobal(int item, std::uint32_t value) {
    if (item == kUsagePage) globals_.usage_page = value & 0xFFFF;
    if (item == kReportSize) globals_.report_size = value;
    if (item == kReportCount) globals_.report_count = value;
    if (item == kReportId) {
      if (value == 0 || value > 255) fail("has the report id " + std::to_string(value));
      globals_.report_id = static_cast<std::uint8_t>(value);
    }
    if (item == kPush) {
      if (stack_.size() == kMaxStack) fail("pushes too often");
      stack_.push_back(globals_);
    }
    if (item == kPop) {
      if (stack_.empty()) fail("pops what was not pushed");
      globals_ = stack_.back();
      stack_.pop_back();
    }
  }

  void openCollection(std::uint32_t type) {
    if (++depth_ > kMaxDepth) fail("nests collections too deeply");
    if (type == kApplication && !has_application_) {
      has_application_ = true;
      layout_.usage_page = static_cast<std::uint16_t>(usage_ >> 16);
      layout_.usage = static_cast<std::uint16_t>(usage_ & 0xFFFF);
    }
    usage_ = 0;
  }

  void addField(Kind kind) {
    usage_ = 0;
    const std::uint64_t field = std::uint64_t{globals_.report_size} * globals_.report_count;
    std::size_t& bits = bits_[{kind, globals_.report_id}];
    if (field > kMaxReportBits || bits + field > kMaxReportBits) fail("describes a report of more than 4096 bytes");
    bits += field;
  }

  ReportLayout finish() {
    for (const auto& [key, bits] : bits_) {
      const std::size_t id_byte = key.second == 0 ? 0 : 1;
      layout_.reports.push_back({key.first, key.second, (bits + 7) / 8 + id_byte});
    }
    return layout_;
  }
};

struct Expected {
  Kind kind;
  std::uint8_t id;
  std::size_t bytes;
  const char* name;
  bool haptic_only;
};

constexpr Expected kExpected[] = {
    {Kind::Input, vibe_firmware::kInputReportId, vibe_firmware::kInputReportSize, "input report", false},
    {Kind::Feature, vibe_firmware::kParameterReportId, vibe_firmware::kParameterReportSize, "parameter report", true},
    {Kind::Feature, vibe_firmware::kStatusReportId, vibe_firmware::kStatusReportSize, "status report", false},
    {Kind::Feature, vibe_firmware::kAxisReportId, vibe_firmware::kAxisReportSize, "report on axis 0", false},
    {Kind::Feature, vibe_firmware::kAxisReportId + 1, vibe_firmware::kAxisReportSize, "report on axis 1", false},
};

constexpr std::uint16_t kGenericDesktop = 1;
constexpr std::uint16_t kGamepad = 5;

}  // namespace

std::size_t ReportLayout::sizeOf(ReportSize::Kind kind, std::uint8_t id) const {
  for (const ReportSize& report : reports) {
    if (report.kind == kind && report.id == id) return report.bytes;
  }
  return 0;
}

ReportLayout parseReportDescriptor(const std::uint8_t* bytes, std::size_t size) {
  return Parser(bytes, size).parse();
}

const char* deviceName(DeviceKind kind) {
  return kind == DeviceKind::Haptic ? "haptic device" : "input device";
}

void checkReportDescriptor(const std::uint8_t* bytes, std::size_t size, DeviceKind kind) {
  const ReportLayout layout = parseReportDescriptor(bytes, size);
  const std::string remedy =
      "; select another device by its serial number in the calibration, or, if its firmware is of another release, "
      "install that of this one.";
  if (layout.usage_page != kGenericDesktop || layout.usage != kGamepad) {
    throw Error(std::string("It is not a ") + deviceName(kind) + ": its report descriptor has usage " +
                std::to_string(layout.usage) + " of page " + std::to_string(layout.usage_page) +
                ", not a gamepad's 5 of 1" + remedy);
  }
  for (const Expected& report : kExpected) {
    if (report.haptic_only && kind != DeviceKind::Haptic) continue;
    const std::size_t found = layout.sizeOf(report.kind, report.id);
    if (found == report.bytes) continue;
    throw Error(std::string("It is not a ") + deviceName(kind) + " of this release: its " + report.name + " (id " +
                std::to_string(report.id) + ") has " + std::to_string(found) + " bytes instead of " +
                std::to_string(report.bytes) + remedy);
  }
}

}  // namespace vibe::hardware
