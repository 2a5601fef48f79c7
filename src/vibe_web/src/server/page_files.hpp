#pragma once

#include <memory>
#include <string>

namespace vibe::web {

/// What a path of the server holds.
struct PageFile {
  std::string type;  ///< media type
  std::shared_ptr<const std::string> content;
  bool gzipped = false;
};

/// The file of a page that a path asks for: "/" is index.html. Beside a file may stand FILE.gz, which is preferred.
/// Only plain names below the folder are answered: letters, digits, - _ . and /, and no part of a name begins with a
/// dot.
/// @param folder     of the page
/// @param path       of the request, without its query
/// @param take_gzip  whether the client can unpack
/// @return content null: there is none
PageFile readPageFile(const std::string& folder, const std::string& path, bool take_gzip);

/// Of a file; null where there is none, or no ordinary one.
std::shared_ptr<const std::string> contentOf(const std::string& file);

/// Whether a header Accept-Encoding lets an answer be packed so (RFC 9110, 12.5.3).
bool takesGzip(const std::string& accepted);

/// Of a file by its ending; application/octet-stream for those that no page has.
std::string mediaType(const std::string& path);

}  // namespace vibe::web
