#pragma once

#include <cstddef>
#include <initializer_list>
#include <utility>
#include <vector>

namespace vibe {

/// A list that is filled anew in every step. Removed elements keep their memory, so that nothing is allocated once the
/// list has grown to its largest size.
template <class T>
class RowList {
 public:
  RowList() = default;
  RowList(std::initializer_list<T> items) : items_(items), size_(items.size()) {}

  /// One more element, to be set completely: it may hold the values of an element that was removed.
  T& add() {
    if (size_ == items_.size()) items_.emplace_back();
    return items_[size_++];
  }
  void push_back(T item) { add() = std::move(item); }
  void clear() { size_ = 0; }

  std::size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }
  T& operator[](std::size_t i) { return items_[i]; }
  const T& operator[](std::size_t i) const { return items_[i]; }
  T& back() { return items_[size_ - 1]; }
  const T& back() const { return items_[size_ - 1]; }
  T* begin() { return items_.data(); }
  T* end() { return items_.data() + size_; }
  const T* begin() const { return items_.data(); }
  const T* end() const { return items_.data() + size_; }

 private:
  std::vector<T> items_;  // the first size_ of them
  std::size_t size_ = 0;
};

}  // namespace vibe
