#pragma once

#include <cstring>
#include <string>
#include <type_traits>
#include <utility>

#include "protocol/message_kind.hpp"

namespace vibe::web {

/// Writes a message for a page, which reads it as typed arrays in place: numbers are little-endian, as on every machine
/// that ROS runs on, and stand at multiples of their size if they are put in the order of the layouts.
class ByteWriter {
 public:
  explicit ByteWriter(Kind kind, std::size_t expected = 64) {
    bytes_.reserve(expected);
    put(static_cast<std::uint8_t>(kind));
  }

  template <class T>
  void put(T value) {
    putAll(&value, 1);
  }

  template <class T>
  void putAll(const T* values, std::size_t count) {
    static_assert(std::is_arithmetic_v<T>, "only numbers have one layout");
    if (count == 0) return;
    const std::size_t end = bytes_.size();
    bytes_.resize(end + count * sizeof(T));
    std::memcpy(bytes_.data() + end, values, count * sizeof(T));
  }

  Bytes take() { return std::move(bytes_); }

 private:
  Bytes bytes_;
};

inline Bytes textMessage(Kind kind, const std::string& text) {
  ByteWriter writer(kind, text.size() + 1);
  writer.putAll(text.data(), text.size());
  return writer.take();
}

}  // namespace vibe::web
