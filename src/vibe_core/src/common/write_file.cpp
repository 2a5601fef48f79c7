#include "vibe_core/common/write_file.hpp"

#include <cstdio>
#include <filesystem>
#include <fstream>

#include "vibe_core/common/error.hpp"

namespace vibe {
namespace {

bool write(const std::string& file, const std::string& content) {
  std::ofstream out(file, std::ios::binary | std::ios::trunc);
  out << content;
  out.close();
  return static_cast<bool>(out);
}

}  // namespace

void writeFile(const std::string& file, const std::string& content, const std::string& what) {
  std::error_code unknown;
  const std::filesystem::path target = std::filesystem::weakly_canonical(file, unknown);  // a link stays a link
  const bool special = std::filesystem::exists(target, unknown) && !std::filesystem::is_regular_file(target, unknown);
  const std::string place = target.empty() ? file : target.string(), part = special ? place : place + ".part";
  if (!write(part, content)) {
    if (!special) std::remove(part.c_str());
    throw Error(what + " '" + file + "' could not be written; check that the folder exists and has room.");
  }
  if (special || std::rename(part.c_str(), place.c_str()) == 0) return;
  std::remove(part.c_str());
  throw Error(what + " '" + file + "' could not be put in place; check the permissions of its folder.");
}

}  // namespace vibe
