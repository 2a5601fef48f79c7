#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "vibe_core/input/step_input.hpp"

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

/// One message of the topic applied_input.
struct RecordedStep {
  std::uint64_t step = 0;  ///< its number
  StepInput input;
  std::uint32_t run = 1;         ///< see vibe_msgs/StepInput
  std::uint64_t session = 0;     ///< see vibe_msgs/StepInput; 0 in those of older releases
  std::int64_t stamp = 0;        ///< of the start of the step [ns]
  bool has_hashes = false;       ///< false: of a release that did not record them
  std::uint64_t input_hash = 0;  ///< of step and input
  std::uint64_t state_hash = 0;  ///< of the state at the start of the step
};

/// Reads serialised vibe_msgs/StepInput of this and of older releases. It finds the fields by the definition that a
/// recording carries, so their order, and fields that it does not know, do not matter. Versions: kStepInputVersion.
class StepInputReader {
 public:
  /// @param definition  of the message, see MessageLayout
  explicit StepInputReader(const std::string& definition) : layout_(definition) {}

  /// What the step used, bit for bit. Fields that an older version lacks have their defaults.
  /// @throws Error if the message is of a version that this build does not read, or damaged
  RecordedStep read(const std::uint8_t* bytes, std::size_t size) const;

 private:
  MessageLayout layout_;
};

}  // namespace vibe::sim
