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

#include "vibe_core/files/fnv1a.hpp"

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

/// Whether T is a struct described by VIBE_FIELDS.
template <class T, class = void>
constexpr bool kDescribed = false;
template <class T>
constexpr bool kDescribed<T, std::void_t<decltype(FieldTable<T>::kNames)>> = true;

/// Whether T is a std::vector.
template <class T>
constexpr bool kList = false;
template <class T>
constexpr bool kList<std::vector<T>> = true;

/// Whether T is a single value of which blocks are made: a number, a bool or an enum.
template <class T>
constexpr bool kPlain = std::is_arithmetic_v<T> || std::is_enum_v<T>;

/// A block: a fixed number of contiguous plain values.
template <class T>
struct Block {
  static_assert(kPlain<T>, "a field is a plain value, an array, a fixed matrix, a list or a struct with VIBE_FIELDS");
  using Item = T;                           ///< type of one value
  static constexpr std::size_t kCount = 1;  ///< number of values
  /// Where the first value is.
  template <class U>
  static auto* data(U& value) {
    return &value;
  }
};

/// An array is a block of its items.
template <class T, std::size_t N>
struct Block<std::array<T, N>> {
  static_assert(kPlain<T>);
  using Item = T;                           ///< type of one item
  static constexpr std::size_t kCount = N;  ///< number of items
  /// Where the first item is.
  template <class U>
  static auto* data(U& value) {
    return value.data();
  }
};

/// A fixed matrix is a block of its coefficients.
template <class T, int Rows, int Columns, int Options>
struct Block<Eigen::Matrix<T, Rows, Columns, Options>> {
  static_assert(kPlain<T> && Rows > 0 && Columns > 0);
  using Item = T;                                                                  ///< type of one coefficient
  static constexpr std::size_t kCount = static_cast<std::size_t>(Rows) * Columns;  ///< number of coefficients
  /// Where the first coefficient is; the others follow as the matrix stores them, by default column by column.
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

/// Calls visit(name, member) for every member of a tuple of references, in order.
/// @param names  of the members: "first, second, third"
template <class Tuple, class Visit, std::size_t... I>
void visitEach(std::string_view names, const Tuple& members, Visit& visit, std::index_sequence<I...>) {
  (visit(nameAt(names, I), std::get<I>(members)), ...);
}

/// Calls visit(name, member of a, member of b) for every member of two tuples of references, in order.
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

/// A plain value as text: reals with 17 digits, of which the same bits can be read back, others as whole numbers.
template <class T>
std::string plainText(const T& value) {
  std::ostringstream text;
  text.precision(17);
  if constexpr (std::is_enum_v<T> || (std::is_integral_v<T> && std::is_signed_v<T>))
    text << static_cast<std::int64_t>(value);
  else if constexpr (std::is_integral_v<T>)
    text << static_cast<std::uint64_t>(value);
  else
    text << value;
  return text.str();
}

/// Where the bits of two blocks first differ, with both values: "place[2]: 0.02 against 0.03"; empty: nowhere. A block
/// of one value has no index.
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

/// Where two lists first differ, or how many items they have if not the same number; empty: nowhere.
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

/// Where two values of a type that a field may have first differ, see firstDifference(); empty: nowhere.
/// @param place  what leads to both, such as "procedure.sutures[1]"; empty: nothing does
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

/// "first:i4x1;second:f8x3;": names of members and the typeText() of their types in a tuple.
template <class Tuple, std::size_t... I>
std::string memberList(std::string_view names, std::index_sequence<I...>) {
  std::string text;
  ((text +=
    std::string(nameAt(names, I)) + ":" + typeText<std::remove_reference_t<std::tuple_element_t<I, Tuple>>>() + ";"),
   ...);
  return text;
}

/// A type as text. "f8x3": three floating-point numbers of eight bytes each; "i" stands for whole numbers and enums,
/// "b" for bool, "[f8x3]" for a list, "{name:f8x3;}" for a described struct.
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
