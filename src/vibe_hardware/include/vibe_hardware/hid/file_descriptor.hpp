#pragma once
#include <unistd.h>

#include <utility>

namespace vibe::hardware {

/// An open file that is closed with its owner.
class FileDescriptor {
 public:
  explicit FileDescriptor(int number = -1) : number_(number) {}  ///< takes over an open file; -1: none
  /// `other` has none afterwards.
  FileDescriptor(FileDescriptor&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
  FileDescriptor& operator=(FileDescriptor&& other) noexcept {
    std::swap(number_, other.number_);
    return *this;
  }
  ~FileDescriptor() {
    if (number_ >= 0) ::close(number_);
  }

  int get() const { return number_; }  ///< the number, still owned here; -1: none
  explicit operator bool() const { return number_ >= 0; }

 private:
  int number_;
};

}  // namespace vibe::hardware
