#include "server/page_files.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <utility>

#include <boost/beast/http/rfc7230.hpp>

namespace vibe::web {

namespace {

bool isPlain(const std::string& path) {
  const auto allowed = [](unsigned char c) {
    return std::isalnum(c) != 0 || c == '-' || c == '_' || c == '.' || c == '/';
  };
  return !path.empty() && path[0] == '/' && path.find("/.") == std::string::npos &&
         path.find("//") == std::string::npos && std::all_of(path.begin(), path.end(), allowed);
}

}  // namespace

std::shared_ptr<const std::string> contentOf(const std::string& file) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error)) return nullptr;  // a folder opens, and throws when it is read
  std::ifstream stream(file, std::ios::binary);
  if (!stream) return nullptr;
  return std::make_shared<const std::string>(std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>());
}

bool takesGzip(const std::string& accepted) {
  using boost::beast::iequals;
  std::optional<bool> gzip, others;
  for (const auto& [coding, parameters] : boost::beast::http::ext_list(accepted)) {
    bool wanted = true;
    for (const auto& [name, value] : parameters)
      if (iequals(name, "q")) wanted = std::atof(std::string(value).c_str()) > 0;
    if (iequals(coding, "gzip")) gzip = wanted;
    if (coding == "*") others = wanted;
  }
  return gzip.value_or(others.value_or(false));
}

std::string mediaType(const std::string& path) {
  static const std::array<std::pair<const char*, const char*>, 7> types{
      {{".html", "text/html; charset=utf-8"},
       {".js", "text/javascript; charset=utf-8"},
       {".css", "text/css; charset=utf-8"},
       {".svg", "image/svg+xml"},
       {".png", "image/png"},
       {".json", "application/json"},
       {".webmanifest", "application/manifest+json"}}};
  for (const auto& [ending, type] : types) {
    const std::string end(ending);
    if (path.size() > end.size() && path.compare(path.size() - end.size(), end.size(), end) == 0) return type;
  }
  return "application/octet-stream";
}

PageFile readPageFile(const std::string& folder, const std::string& path, bool take_gzip) {
  PageFile file;
  const std::string name = path == "/" ? "/index.html" : path;
  if (!isPlain(name) || name.back() == '/') return file;
  file.type = mediaType(name);
  if (take_gzip) file.content = contentOf(folder + name + ".gz");
  file.gzipped = static_cast<bool>(file.content);
  if (!file.content) file.content = contentOf(folder + name);
  return file;
}

}  // namespace vibe::web
