#pragma once

#include <array>
#include <atomic>
#include <memory>

namespace vibe {

/// Objects that are large and needed for moments only, one set for all threads of the process. Takes no lock. Makes an
/// object only where more are needed at once than ever before, and keeps it until the end of the process.
/// @tparam T  default constructible
template <class T>
class LendingPool {
 public:
  /// An object, as its last user has left it; goes back at the end of the scope.
  class Loan {
   public:
    Loan() : object_(take()) {}
    ~Loan() { giveBack(object_); }
    Loan(const Loan&) = delete;
    Loan& operator=(const Loan&) = delete;
    T* operator->() const { return object_; }
    T& operator*() const { return *object_; }

   private:
    T* object_;
  };

 private:
  static constexpr std::size_t kKept = 32;
  static inline std::array<std::atomic<T*>, kKept> kept_{};  // null: lent, or not made yet

  static T* take() {
    for (std::atomic<T*>& place : kept_)
      if (T* const object = place.exchange(nullptr, std::memory_order_acq_rel)) return object;
    return std::make_unique<T>().release();
  }
  static void giveBack(T* object) {
    for (std::atomic<T*>& place : kept_) {
      T* none = nullptr;
      if (place.compare_exchange_strong(none, object, std::memory_order_acq_rel)) return;
    }
    const std::unique_ptr<T> too_many(object);
  }
};

}  // namespace vibe
