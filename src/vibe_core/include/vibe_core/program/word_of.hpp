#pragma once
#include <cstddef>

namespace vibe {

/// The word of an enumerator, from a table with one word for each in their order.
/// @param unknown  for a value that is none of them
template <class Enum, std::size_t Count>
constexpr const char* wordOf(Enum value, const char* const (&words)[Count], const char* unknown = "unknown") {
  const auto index = static_cast<std::size_t>(value);
  return index < Count ? words[index] : unknown;
}

}  // namespace vibe
