#include "vibe_core/common/fnv1a.hpp"
#include "vibe_core/simulation/simulator.hpp"
#include "vibe_core/state/state_fields.hpp"

namespace vibe {

namespace {

class HashArchive {
 public:
  template <class T>
  void block(const T* data, std::size_t count) {
    hash_.add(data, count * sizeof(T));
  }
  template <class T>
  void list(const std::vector<T>& items) {
    transferList(*this, items);
  }
  std::uint64_t result() const { return hash_.result(); }

 private:
  Fnv1a hash_;
};

}  // namespace

std::uint64_t hash(const State& state) {
  HashArchive archive;
  const std::uint64_t fields = fieldFingerprint<State>();
  archive.block(&fields, 1);
  transfer(archive, state);
  return archive.result();
}

}  // namespace vibe
