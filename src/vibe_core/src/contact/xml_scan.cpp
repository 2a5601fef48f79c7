#include "contact/xml_scan.hpp"

#include <algorithm>
#include <cctype>
#include <vector>

namespace vibe {

namespace {

class TagScanner {
 public:
  explicit TagScanner(const std::string& text) : text_(text) {}

  // position of the first broken tag; npos if there is none
  std::size_t findBroken() {
    while ((at_ = text_.find('<', at_)) != std::string::npos) {
      const std::size_t tag = at_;
      if (!skipTag()) return tag;
    }
    return open_.empty() ? std::string::npos : open_.back().at;
  }

 private:
  struct Element {
    std::string name;
    std::size_t at;
  };

  bool startsWith(const char* what) const {
    return text_.compare(at_, std::char_traits<char>::length(what), what) == 0;
  }

  bool skipPast(const std::string& end) {
    const std::size_t found = text_.find(end, at_);
    if (found == std::string::npos) return false;
    at_ = found + end.size();
    return true;
  }

  void skipSpace() {
    while (at_ < text_.size() && std::isspace(static_cast<unsigned char>(text_[at_])) != 0) ++at_;
  }

  std::string readName() {
    const std::size_t begin = at_;
    while (at_ < text_.size() && (std::isalnum(static_cast<unsigned char>(text_[at_])) != 0 || text_[at_] == '_' ||
                                  text_[at_] == '-' || text_[at_] == ':' || text_[at_] == '.'))
      ++at_;
    return text_.substr(begin, at_ - begin);
  }

  bool skipTag() {
    if (startsWith("<!--")) return skipPast("-->");
    if (startsWith("<?")) return skipPast("?>");
    if (startsWith("<!")) return skipPast(">");
    if (startsWith("</")) return skipEndTag();
    const std::size_t begin = at_++;
    const std::string name = readName();
    if (name.empty() || !skipAttributes()) return false;
    const bool closes_itself = startsWith("/>");
    if (!closes_itself) open_.push_back({name, begin});
    return skipPast(">");
  }

  bool skipEndTag() {
    at_ += 2;
    const std::string name = readName();
    if (open_.empty() || open_.back().name != name) return false;
    open_.pop_back();
    skipSpace();
    return startsWith(">");
  }

  // up to the tag's "/>" or ">"
  bool skipAttributes() {
    for (skipSpace(); !startsWith("/>") && !startsWith(">"); skipSpace()) {
      if (readName().empty()) return false;
      skipSpace();
      if (!startsWith("=")) return false;
      ++at_;
      skipSpace();
      if (!startsWith("\"") && !startsWith("'")) return false;
      const char quote = text_[at_++];
      const std::size_t end = text_.find(quote, at_);
      if (end == std::string::npos || text_.find('<', at_) < end) return false;
      at_ = end + 1;
    }
    return true;
  }

  const std::string& text_;
  std::size_t at_ = 0;
  std::vector<Element> open_;
};

}  // namespace

int firstBrokenTagLine(const std::string& xml) {
  const std::size_t at = TagScanner(xml).findBroken();
  if (at == std::string::npos) return 0;
  return static_cast<int>(std::count(xml.begin(), xml.begin() + static_cast<std::ptrdiff_t>(at), '\n')) + 1;
}

}  // namespace vibe
