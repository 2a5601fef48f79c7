#include "vibe_core/scene/nearest_key.hpp"

#include <algorithm>
#include <cctype>

namespace vibe {
namespace {

/// Longer words come from broken files and are not compared, which would be slow.
constexpr std::size_t kLongestWord = 64;

std::string normalised(const std::string& word) {
  std::string result = word.substr(0, kLongestWord);
  for (char& c : result) {
    c = c == '-' || c == ' ' ? '_' : static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  }
  return result;
}

}  // namespace

int editDistance(const std::string& a, const std::string& b) {
  std::vector<int> before(b.size() + 1), last(b.size() + 1), now(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) last[j] = static_cast<int>(j);
  for (std::size_t i = 1; i <= a.size(); ++i) {
    now[0] = static_cast<int>(i);
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const int replace = last[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      now[j] = std::min({last[j] + 1, now[j - 1] + 1, replace});
      const bool swapped = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
      if (swapped) now[j] = std::min(now[j], before[j - 2] + 1);
    }
    before.swap(last);
    last.swap(now);
  }
  return last[b.size()];
}

std::string nearestKey(const std::string& word, const std::vector<std::string>& candidates) {
  const std::string wanted = normalised(word);
  std::string best;
  // At most two edits in a short word, or a third of a long one; a farther guess would confuse.
  int best_distance = std::max(2, static_cast<int>(wanted.size()) / 3) + 1;
  for (const std::string& candidate : candidates) {
    const int distance = editDistance(wanted, normalised(candidate));
    const bool shares_something = distance < static_cast<int>(std::max(wanted.size(), candidate.size()));
    if (distance < best_distance && shares_something) {
      best = candidate;
      best_distance = distance;
    }
  }
  return best;
}

std::string suggestKey(const std::string& word, const std::vector<std::string>& candidates) {
  const std::string nearest = nearestKey(word, candidates);
  if (!nearest.empty()) return "did you mean '" + nearest + "'?";
  std::string list;
  for (const std::string& candidate : candidates) list += (list.empty() ? "" : ", ") + candidate;
  return "known are " + list;
}

}  // namespace vibe
