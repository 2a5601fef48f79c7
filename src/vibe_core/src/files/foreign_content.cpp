#include "vibe_core/files/foreign_content.hpp"

#include <array>
#include <cctype>

namespace vibe {

namespace {

struct Signature {
  std::string_view beginning;
  const char* clause;
};

constexpr std::array<Signature, 7> kSignatures{{
    {"version https://git-lfs.github.com/spec/",
     "is a Git LFS pointer, which only names the file; fetch the file with 'git lfs pull' in its repository"},
    {"PK\x03\x04", "is a ZIP archive; unpack it"},
    {"\x1f\x8b", "is compressed by gzip; unpack it"},
    {"7z\xbc\xaf\x27\x1c", "is a 7z archive; unpack it"},
    {"\xfd"
     "7zXZ",
     "is compressed by xz; unpack it"},
    {"\xff\xfe", "is text in UTF-16; save it as UTF-8"},
    {"\xfe\xff", "is text in UTF-16; save it as UTF-8"},
}};

/// Text without the mark of UTF-8, blanks and empty lines at its beginning, in small letters.
std::string smallLetters(std::string_view content) {
  if (content.substr(0, 3) == "\xef\xbb\xbf") content.remove_prefix(3);
  const std::size_t begin = content.find_first_not_of(" \t\r\n");
  std::string text;
  if (begin == std::string_view::npos) return text;
  for (const char c : content.substr(begin, 1000))
    text += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

}  // namespace

std::string foreignContent(std::string_view content) {
  if (content.empty()) return "is empty; it may not have been written or copied to its end";
  for (const Signature& signature : kSignatures)
    if (content.substr(0, signature.beginning.size()) == signature.beginning) return signature.clause;
  const std::string text = smallLetters(content);
  const bool page = text.rfind("<!doctype html", 0) == 0 || text.rfind("<html", 0) == 0 ||
                    (text.rfind("<?xml", 0) == 0 && text.find("<html") != std::string::npos);
  if (page)
    return "is a web page (HTML), which a server may have sent in the place of the file; open it in a browser to see "
           "what it says, and download the file itself";
  return "";
}

}  // namespace vibe
