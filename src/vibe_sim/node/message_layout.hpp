#pragma once
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace vibe::sim {

/// Where the fields of a serialised ROS message are, from the text of its definition. For messages of other releases,
/// which the generated classes cannot read.
class MessageLayout {
 public:
  /// One or several values of a built-in type. Fields of contained messages are named "outer.inner".
  struct Field {
    std::string name;
    std::string type;    ///< "float64", "uint8", "string" ...
    int count = 1;       ///< number of values; of the arrays of variable length kVariable
    std::size_t at = 0;  ///< out of locate(): offset of the first value [bytes]
  };
  static constexpr int kVariable = -1;

  /// @param definition  as in the connection header of a bag: the message, then after a line of '=' and a line
  ///                    "MSG: package/Name" each message that it contains
  /// @throws Error if it uses a type that it does not define, or an array of messages
  explicit MessageLayout(const std::string& definition);

  const std::vector<Field>& fields() const { return fields_; }

  /// The fields with their places in one message.
  /// @throws Error if the message ends too early
  std::vector<Field> locate(const std::uint8_t* bytes, std::size_t size) const;

 private:
  std::vector<Field> fields_;
};

}  // namespace vibe::sim
