#pragma once

#include <functional>
#include <string>

#include "vibe_core/program/error.hpp"

namespace vibe {

/// What a call reports as vibe::Error, or "no error". Anything else that is thrown fails the test by itself.
inline std::string errorOf(const std::function<void()>& call) {
  try {
    call();
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

}  // namespace vibe

/// The call throws a vibe::Error whose text contains `part`.
#define EXPECT_ERROR(call, part)                                                                      \
  do {                                                                                                \
    const std::string message = vibe::errorOf([&] { (void)(call); });                                 \
    EXPECT_NE(message.find(part), std::string::npos) << "got: " << message << "\nwanted: " << (part); \
  } while (false)
