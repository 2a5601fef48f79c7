#pragma once
#include <string>
#include <vector>

namespace vibe {

/// Number of inserted, deleted, replaced and swapped neighbouring characters between two words
/// (optimal string alignment distance: Damerau 1964, Levenshtein 1966).
int editDistance(const std::string& a, const std::string& b);

/// The candidate that a user most likely meant by `word`, or empty if none is near. Upper and lower case, '-' and '_'
/// count as equal; the first of equally near candidates is returned.
std::string nearestKey(const std::string& word, const std::vector<std::string>& candidates);

/// Remedy for an unknown word: "did you mean 'x'?" or, without a near candidate, "known are a, b, c".
std::string suggestKey(const std::string& word, const std::vector<std::string>& candidates);

}  // namespace vibe
