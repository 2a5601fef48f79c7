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

template <class T>
void addFields(const T& object, HashArchive& archive) {
  const std::uint64_t fields = fieldFingerprint<T>();
  archive.block(&fields, 1);
  transfer(archive, object);
}

}  // namespace

std::uint64_t hash(const State& state) {
  HashArchive archive;
  addFields(state, archive);
  return archive.result();
}

std::uint64_t hash(const StepInput& input, std::int64_t step) {
  HashArchive archive;
  archive.block(&step, 1);
  addFields(input, archive);
  return archive.result();
}

std::uint64_t hash(const std::string& text) {
  return XXH3_64bits(text.data(), text.size());
}

}  // namespace vibe
