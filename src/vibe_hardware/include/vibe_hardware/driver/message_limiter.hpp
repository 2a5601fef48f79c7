#pragma once
#include <functional>
#include <map>
#include <string>

namespace vibe::hardware {

enum class Severity : unsigned char { Info, Warning };

/// Where sentences for the user go.
using MessageSink = std::function<void(Severity, const std::string&)>;

/// Passes sentences on, each kind at most once per period; how many were held back is added to the next one.
class MessageLimiter {
 public:
  static constexpr double kPeriod = 10;  ///< [s]

  explicit MessageLimiter(MessageSink sink) : sink_(std::move(sink)) {}

  void info(const std::string& sentence) const { sink_(Severity::Info, sentence); }
  void warn(const std::string& kind, const std::string& sentence, double now);
  /// A sentence that stays true: said once, and again only after forget().
  void warnOnce(const std::string& kind, const std::string& sentence);
  void forget(const std::string& kind) { kinds_.erase(kind); }

 private:
  struct Kind {
    double last = 0;
    int held_back = 0;
    std::string sentence;
  };

  MessageSink sink_;
  std::map<std::string, Kind> kinds_;
};

}  // namespace vibe::hardware
