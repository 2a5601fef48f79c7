#pragma once
#include <cstddef>
#include <cstdint>
#include <cstring>

namespace vibe {

/// FNV-1a, 64 bit (Fowler, Noll, Vo; http://www.isthe.com/chongo/tech/comp/fnv): a checksum, not a cryptographic hash.
class Fnv1a {
 public:
  /// Hashes bytes, one after the other: in pieces or at once gives the same.
  void add(const void* data, std::size_t size) {
    const auto* bytes = static_cast<const unsigned char*>(data);
    for (std::size_t i = 0; i < size; ++i) value_ = (value_ ^ bytes[i]) * 0x100000001b3ULL;
  }

  /// Hashes whole 32-bit words instead of bytes. The result differs and is four times as fast to compute.
  template <class Word>
  void addWords(const Word* values, std::size_t count) {
    static_assert(sizeof(Word) == sizeof(std::uint32_t));
    for (std::size_t i = 0; i < count; ++i) {
      std::uint32_t bits = 0;
      std::memcpy(&bits, values + i, sizeof bits);
      value_ = (value_ ^ bits) * 0x100000001b3ULL;
    }
  }

  std::uint64_t result() const { return value_; }  ///< of all that has been added so far

 private:
  std::uint64_t value_ = 0xcbf29ce484222325ULL;
};

}  // namespace vibe
