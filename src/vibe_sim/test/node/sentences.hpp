#pragma once
#include <gtest/gtest.h>

#include <string>

#include "vibe_core/program/error.hpp"

namespace vibe::sim {

/// The sentence of the vibe::Error with which a call fails; empty if it does not fail.
template <typename Call>
std::string sentenceOf(Call call) {
  try {
    call();
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

inline void expectMentions(const std::string& sentence, const std::string& part) {
  EXPECT_NE(sentence.find(part), std::string::npos) << "'" << sentence << "' lacks '" << part << "'";
}

}  // namespace vibe::sim
