#pragma once
#include <cstddef>
#include <cstdint>
#include <map>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace vibe_firmware {

/// One field of a report as a report descriptor declares it (HID 1.11, section 6.2.2).
struct HidField {
  std::uint32_t usage_page = 0;
  std::vector<std::uint32_t> usages;  // a range is written out
  std::int32_t logical_minimum = 0, logical_maximum = 0;
  std::uint32_t bits = 0, count = 0;
  std::uint32_t flags = 0;
};

/// A small reader of report descriptors, independent of the one that the host uses.
class HidItems {
 public:
  using Key = std::pair<char, std::uint32_t>;  // 'i' input, 'o' output, 'f' feature; report id

  HidItems(const std::uint8_t* bytes, std::size_t size) {
    for (std::size_t i = 0; i < size;) {
      const std::uint8_t prefix = bytes[i];
      const std::size_t length = (prefix & 3) == 3 ? 4 : prefix & 3;
      if (i + 1 + length > size) throw std::runtime_error("item is cut off");
      std::uint32_t value = 0;
      for (std::size_t k = 0; k < length; ++k) value |= static_cast<std::uint32_t>(bytes[i + 1 + k]) << 8 * k;
      take(prefix & 0xFC, value, length);
      i += 1 + length;
    }
    if (depth_ != 0) throw std::runtime_error("collection is not closed");
  }

  const std::map<Key, std::vector<HidField>>& reports() const { return reports_; }
  const std::set<std::pair<std::uint32_t, std::uint32_t>>& collections() const { return collections_; }

  /// Bytes of a report with its id.
  std::size_t size(char kind, std::uint32_t id) const {
    std::size_t bits = 8;
    for (const HidField& field : reports_.at({kind, id})) bits += static_cast<std::size_t>(field.bits) * field.count;
    if (bits % 8 != 0) throw std::runtime_error("report is no whole number of bytes");
    return bits / 8;
  }

 private:
  static std::int32_t withSign(std::uint32_t value, std::size_t length) {
    if (length == 1) return static_cast<std::int8_t>(value);
    if (length == 2) return static_cast<std::int16_t>(value);
    return static_cast<std::int32_t>(value);
  }

  void take(int tag, std::uint32_t value, std::size_t length) {
    switch (tag) {
      case 0x04:
        field_.usage_page = value;
        return;
      case 0x14:
        field_.logical_minimum = withSign(value, length);
        return;
      case 0x24:
        field_.logical_maximum = withSign(value, length);
        return;
      case 0x74:
        field_.bits = value;
        return;
      case 0x94:
        field_.count = value;
        return;
      case 0x84:
        id_ = value;
        return;
      case 0x08:
        usages_.push_back(value);
        return;
      case 0x18:
        first_ = value;
        return;
      case 0x28:
        for (std::uint32_t usage = first_; usage <= value; ++usage) usages_.push_back(usage);
        return;
      default:
        main(tag, value);
    }
  }

  void main(int tag, std::uint32_t value) {
    switch (tag) {
      case 0xA0:
        if (!usages_.empty()) collections_.insert({field_.usage_page, usages_.back()});
        ++depth_;
        break;
      case 0xC0:
        --depth_;
        break;
      case 0x80:
        add('i', value);
        break;
      case 0x90:
        add('o', value);
        break;
      case 0xB0:
        add('f', value);
        break;
      default:
        throw std::runtime_error("unknown item " + std::to_string(tag));
    }
    usages_.clear();
  }

  void add(char kind, std::uint32_t flags) {
    field_.usages = usages_;
    field_.flags = flags;
    reports_[{kind, id_}].push_back(field_);
  }

  HidField field_;
  std::uint32_t id_ = 0, first_ = 0;
  int depth_ = 0;
  std::vector<std::uint32_t> usages_;
  std::map<Key, std::vector<HidField>> reports_;
  std::set<std::pair<std::uint32_t, std::uint32_t>> collections_;
};

}  // namespace vibe_firmware
