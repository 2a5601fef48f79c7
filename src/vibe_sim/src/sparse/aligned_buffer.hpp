#pragma once

#include <cstdint>
#include <vector>

namespace vibe {

/// Memory that starts at a cache line, with a line of room behind.
template <class Number>
class AlignedBuffer {
 public:
  void resize(std::int64_t count) {
    memory_.assign(count + 2 * kLine, Number());
    const auto address = reinterpret_cast<std::uintptr_t>(memory_.data());
    begin_ = memory_.data() + (kLine - address / sizeof(Number) % kLine) % kLine;
  }
  std::int64_t size() const { return memory_.empty() ? 0 : static_cast<std::int64_t>(memory_.size()) - 2 * kLine; }
  Number* data() { return begin_; }
  const Number* data() const { return begin_; }

 private:
  static constexpr std::int64_t kLine = 64 / sizeof(Number);
  std::vector<Number> memory_;
  Number* begin_ = nullptr;
};

}  // namespace vibe
