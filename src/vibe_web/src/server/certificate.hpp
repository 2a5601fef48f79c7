#pragma once

#include <string>
#include <vector>

namespace vibe::web {

struct Certificates {
  std::string certificate, key;  ///< files in PEM; the first ends with the root
  std::string leaf, root;        ///< the same in DER; root empty: somebody else has signed
};

/// What a server of this machine proves its name with: a root of this machine alone (`root.pem`, ten years), and a
/// certificate that the root has signed (`certificate.pem`, 397 days, as browsers demand), whose keys only their owner
/// can read (P-256). What is not there is made. The certificate is made anew where it ends within 30 days, lacks one of
/// the names or is of another root; the root only where it ends. A certificate that somebody else has signed is used as
/// it is.
/// @param names  host names and numeric addresses under which the server is reached
/// @throws std::runtime_error  a file cannot be used or written
Certificates provideCertificates(const std::string& folder, const std::vector<std::string>& names);

/// SHA-256 of a certificate in DER as colon-separated pairs, as browsers show it.
std::string fingerprint(const std::string& certificate);

}  // namespace vibe::web
