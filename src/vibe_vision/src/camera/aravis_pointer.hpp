#pragma once
#include <arv.h>

#include <memory>
#include <string>

namespace vibe::vision {

struct Unref {
  void operator()(gpointer object) const { g_object_unref(object); }
};
template <class T>
using AravisPointer = std::unique_ptr<T, Unref>;

/// Takes the error of a call of Aravis, and frees it.
class AravisError {
 public:
  AravisError() = default;
  ~AravisError() { g_clear_error(&error_); }
  AravisError(const AravisError&) = delete;
  AravisError& operator=(const AravisError&) = delete;

  GError** slot() {
    g_clear_error(&error_);
    return &error_;
  }
  explicit operator bool() const { return error_ != nullptr; }
  std::string text() const { return error_ ? error_->message : ""; }

 private:
  GError* error_ = nullptr;
};

}  // namespace vibe::vision
