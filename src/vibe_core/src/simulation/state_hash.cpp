// The hash of a state, for replays and snapshots.

// XXH_INLINE_ALL: the functions become part of this file, and nothing is linked
#define XXH_INLINE_ALL
#include <xxhash.h>

#include "vibe_core/model/model.hpp"
#include "vibe_core/state/state_fields.hpp"

namespace vibe {

namespace {

class HashArchive {
 public:
  HashArchive() { XXH3_64bits_reset(&state_); }
  template <class T>
  void block(const T* data, std::size_t count) {
    XXH3_64bits_update(&state_, data, count * sizeof(T));
  }
  template <class T>
  void list(const std::vector<T>& items) {
    transferList(*this, items);
  }
  std::uint64_t result() const { return XXH3_64bits_digest(&state_); }

 private:
  XXH3_state_t state_;
};

// Fields of these types were added later. They count only where they are not as they were made, so that hashes of what
// has no use for them stay.
template <class T>
constexpr bool kLater =
    std::is_same_v<T, MotionState> || std::is_same_v<T, HoldMemory> || std::is_same_v<T, LumenState> ||
    std::is_same_v<T, RelaxationMemory> || std::is_same_v<T, Breath>;

/// @param later  the fields in a row that were added later, as fieldList() has them: "name:type;"
template <class T>
void addFields(const T& object, const std::string& later, HashArchive& archive) {
  static const std::uint64_t fields = [&later] {
    std::string list = fieldList<T>();
    list.erase(list.find(later), later.size());
    Fnv1a hash;
    hash.add(list.data(), list.size());
    return hash.result();
  }();
  archive.block(&fields, 1);
  visitFields(object, [&archive](std::string_view, const auto& member) {
    using Member = std::decay_t<decltype(member)>;
    if constexpr (kLater<Member>)
      if (firstDifference(member, Member()).empty()) return;
    transfer(archive, member);
  });
}

}  // namespace

std::uint64_t hash(const State& state) {
  static const std::string later = "motion:" + fieldList<MotionState>() + ";hold:" + fieldList<HoldMemory>() +
                                   ";lumen:" + fieldList<LumenState>() +
                                   ";relaxation:" + fieldList<RelaxationMemory>() + ";";
  HashArchive archive;
  addFields(state, later, archive);
  return archive.result();
}

std::uint64_t hash(const StepInput& input, std::int64_t step) {
  HashArchive archive;
  archive.block(&step, 1);
  addFields(input, "breath:i1x1;", archive);
  return archive.result();
}

std::uint64_t hash(const std::string& text) {
  return XXH3_64bits(text.data(), text.size());
}

}  // namespace vibe
