#pragma once
#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <sstream>
#include <string>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

#include "vibe_core/common/fnv1a.hpp"

/// Field tables: a struct of plain data lists its members once, and storing, hashing and comparing it are derived from
/// that list.
///
/// A member is a number, an enum, a std::array of these, an Eigen matrix of fixed size, another described struct, or a
/// std::vector of any of them (but not of bool).

/// Describes a struct. Use it in namespace vibe, with all members in the order of their declaration. A structured
/// binding decomposes the struct, so a member missing from the list is a compile-time error.
#define VIBE_FIELDS(Type, ...)                               \
  template <>                                                \
  struct FieldTable<Type> {                                  \
    static constexpr std::string_view kNames = #__VA_ARGS__; \
    template <class Object>                                  \
    static auto members(Object& described_object) {          \
      auto& [__VA_ARGS__] = described_object;                \
      return std::tie(__VA_ARGS__);                          \
    }                                                        \
  }

namespace vibe {

template <class T>
struct FieldTable;

namespace fields {

template <class T, class = void>
constexpr bool kDescribed = false;
template <class T>
constexpr bool kDescribed<T, std::void_t<decltype(FieldTable<T>::kNames)>> = true;

template <class T>
constexpr bool kList = false;
template <class T>
constexpr bool kList<std::vector<T>> = true;

template <class T>
constexpr bool kPlain = std::is_arithmetic_v<T> || std::is_enum_v<T>;

/// A block: a fixed number of contiguous plain values.
template <class T>
struct Block {
  static_assert(kPlain<T>, "a field is a plain value, an array, a fixed matrix, a list or a struct with VIBE_FIELDS");
  using Item = T;
  static constexpr std::size_t kCount = 1;
  template <class U>
  static auto* data(U& value) {
    return &value;
  }
};

template <class T, std::size_t N>
struct Block<std::array<T, N>> {
  static_assert(kPlain<T>);
  using Item = T;
  static constexpr std::size_t kCount = N;
  template <class U>
  static auto* data(U& value) {
    return value.data();
  }
};

template <class T, int Rows, int Columns, int Options>
struct Block<Eigen::Matrix<T, Rows, Columns, Options>> {
  static_assert(kPlain<T> && Rows > 0 && Columns > 0);
  using Item = T;
  static constexpr std::size_t kCount = static_cast<std::size_t>(Rows) * Columns;
  template <class U>
  static auto* data(U& value) {
    return value.data();
  }
};

/// Name number `index` in "first, second, third".
constexpr std::string_view nameAt(std::string_view names, std::size_t index) {
  for (; index > 0; --index) names.remove_prefix(names.find(',') + 1);
  while (!names.empty() && (names.front() == ' ' || names.front() == '\n')) names.remove_prefix(1);
  return names.substr(0, names.find(','));
}

template <class Tuple, class Visit, std::size_t... I>
void visitEach(std::string_view names, const Tuple& members, Visit& visit, std::index_sequence<I...>) {
  (visit(nameAt(names, I), std::get<I>(members)), ...);
}

template <class Tuple, class Visit, std::size_t... I>
void visitPairs(std::string_view names, const Tuple& a, const Tuple& b, Visit& visit, std::index_sequence<I...>) {
  (visit(nameAt(names, I), std::get<I>(a), std::get<I>(b)), ...);
}

}  // namespace fields

/// Calls visit(name, member) for every member of a described struct, in order.
template <class T, class Visit>
void visitFields(T& object, Visit&& visit) {
  using Table = FieldTable<std::remove_const_t<T>>;
  const auto members = Table::members(object);
  fields::visitEach(Table::kNames, members, visit, std::make_index_sequence<std::tuple_size_v<decltype(members)>>());
}

/// Calls visit(name, member of a, member of b) for every member of a described struct, in order.
template <class T, class Visit>
void visitFieldPairs(const T& a, const T& b, Visit&& visit) {
  using Table = FieldTable<T>;
  const auto left = Table::members(a), right = Table::members(b);
  fields::visitPairs(Table::kNames, left, right, visit, std::make_index_sequence<std::tuple_size_v<decltype(left)>>());
}

/// Passes a value through an archive, member by member. The archive provides
///   block(data, count)  for contiguous plain values,
///   list(vector)        for a std::vector: its size, then its items.
template <class Archive, class T>
void transfer(Archive& archive, T& value) {
  using Value = std::remove_const_t<T>;
  if constexpr (fields::kDescribed<Value>) {
    visitFields(value, [&archive](std::string_view, auto& member) { transfer(archive, member); });
  } else if constexpr (fields::kList<Value>) {
    archive.list(value);
  } else {
    archive.block(fields::Block<Value>::data(value), fields::Block<Value>::kCount);
  }
}

/// Implementation of list() for an archive that only reads values: the size as 64 bits, then the items.
template <class Archive, class T>
void transferList(Archive& archive, const std::vector<T>& items) {
  static_assert(!std::is_same_v<T, bool>, "a std::vector<bool> has no bytes; use std::uint8_t");
  const std::uint64_t size = items.size();
  archive.block(&size, 1);
  if constexpr (fields::kPlain<T>) {
    archive.block(items.data(), items.size());
  } else {
    for (const T& item : items) transfer(archive, item);
  }
}

namespace fields {

template <class T>
std::string plainText(const T& value) {
  std::ostringstream text;
  text.precision(17);
  if constexpr (std::is_enum_v<T> || std::is_integral_v<T>)
    text << static_cast<std::int64_t>(value);
  else
    text << value;
  return text.str();
}

template <class T>
std::string blockDifference(const T& a, const T& b, const std::string& place) {
  const auto *left = Block<T>::data(a), *right = Block<T>::data(b);
  for (std::size_t i = 0; i < Block<T>::kCount; ++i)
    if (std::memcmp(left + i, right + i, sizeof *left) != 0)
      return place + (Block<T>::kCount > 1 ? "[" + std::to_string(i) + "]" : "") + ": " + plainText(left[i]) +
             " against " + plainText(right[i]);
  return "";
}

template <class T>
std::string difference(const T& a, const T& b, const std::string& place);

template <class T>
std::string listDifference(const std::vector<T>& a, const std::vector<T>& b, const std::string& place) {
  if (a.size() != b.size())
    return place + ": " + std::to_string(a.size()) + " against " + std::to_string(b.size()) + " items";
  if constexpr (kPlain<T>)
    if (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0) return "";
  for (std::size_t i = 0; i < a.size(); ++i) {
    const std::string found = difference(a[i], b[i], place + "[" + std::to_string(i) + "]");
    if (!found.empty()) return found;
  }
  return "";
}

template <class T>
std::string difference(const T& a, const T& b, const std::string& place) {
  if constexpr (kDescribed<T>) {
    std::string found;
    visitFieldPairs(a, b, [&](std::string_view name, const auto& left, const auto& right) {
      if (found.empty()) found = difference(left, right, (place.empty() ? "" : place + ".") + std::string(name));
    });
    return found;
  } else if constexpr (kList<T>) {
    return listDifference(a, b, place);
  } else {
    return blockDifference(a, b, place);
  }
}

template <class T>
std::string typeText();

template <class Tuple, std::size_t... I>
std::string memberList(std::string_view names, std::index_sequence<I...>) {
  std::string text;
  ((text +=
    std::string(nameAt(names, I)) + ":" + typeText<std::remove_reference_t<std::tuple_element_t<I, Tuple>>>() + ";"),
   ...);
  return text;
}

// "f8x3": three floating-point numbers of eight bytes each
template <class T>
std::string typeText() {
  if constexpr (kDescribed<T>) {
    using Tuple = decltype(FieldTable<T>::members(std::declval<T&>()));
    return "{" + memberList<Tuple>(FieldTable<T>::kNames, std::make_index_sequence<std::tuple_size_v<Tuple>>()) + "}";
  } else if constexpr (kList<T>) {
    return "[" + typeText<typename T::value_type>() + "]";
  } else {
    using Item = typename Block<T>::Item;
    const char* kind = std::is_same_v<Item, bool> ? "b" : std::is_floating_point_v<Item> ? "f" : "i";
    return kind + std::to_string(sizeof(Item)) + "x" + std::to_string(Block<T>::kCount);
  }
}

}  // namespace fields

/// The first field whose bits differ, with both values: "procedure.sutures[1].length[0]: 0.02 against 0.03"; empty if
/// all bits are equal.
template <class T>
std::string firstDifference(const T& a, const T& b) {
  return fields::difference(a, b, "");
}

/// Names and types of all fields of a described struct, in order.
template <class T>
std::string fieldList() {
  return fields::typeText<T>();
}

/// Hash of fieldList(). It differs between builds whose structs differ.
template <class T>
std::uint64_t fieldFingerprint() {
  static const std::uint64_t fingerprint = [] {
    const std::string list = fieldList<T>();
    Fnv1a hash;
    hash.add(list.data(), list.size());
    return hash.result();
  }();
  return fingerprint;
}

}  // namespace vibe
