#pragma once
#include <random>
#include <string>

namespace vibe {

/// Damages a text in one of the ways in which users and disks damage files.
class Mutator {
 public:
  explicit Mutator(unsigned seed) : random_(seed) {}

  std::string mutate(std::string text) {
    for (int k = below(3); k >= 0; --k) change(text);
    return text;
  }

 private:
  std::mt19937 random_;

  int below(std::size_t count) { return static_cast<int>(random_() % count); }

  void change(std::string& text) {
    static const char* const pieces[] = {
        ":", "\n", "  ", "[",   "]", "{",     "}",   "-", "#", "'",  "\"",   "&a",   "*a",     "<<",    "!",    "%",
        "|", ">",  "\t", "---", "~", "1e999", "nan", ",", "?", "\\", "\xff", "mmHg", "- - - ", "0x1p3", "1e-9", " kg"};
    if (text.empty()) return;
    const std::size_t at = static_cast<std::size_t>(below(text.size()));
    const std::size_t length = 1 + static_cast<std::size_t>(below(12));
    switch (below(6)) {
      case 0:
        text[at] = static_cast<char>(below(256));
        break;
      case 1:
        text.erase(at, length);
        break;
      case 2:
        text.insert(at, pieces[below(std::size(pieces))]);
        break;
      case 3:
        text.insert(static_cast<std::size_t>(below(text.size())), text.substr(at, length));
        break;
      case 4:
        text.resize(at);
        break;
      default:
        text.insert(static_cast<std::size_t>(below(text.size())), std::to_string(below(2000000000) - 1000000000));
    }
  }
};

}  // namespace vibe
