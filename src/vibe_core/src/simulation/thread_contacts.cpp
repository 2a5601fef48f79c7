#include "vibe_core/simulation/thread_contacts.hpp"

namespace vibe {

namespace {

void addContacts(const State& state, int number, std::vector<ThreadContact>& contacts) {
  const Suture& suture = state.procedure.sutures[static_cast<std::size_t>(number)];
  const std::size_t first = contacts.size();
  for (std::size_t b = 0; b < suture.bites.size(); ++b)
    contacts.push_back({number, static_cast<int>(b), bitePosition(suture.bites[b], state.x, state.y, state.z),
                        Eigen::Vector3d::Zero()});
  for (std::size_t k = 0; k < suture.tension.size() && k + 1 < suture.bites.size(); ++k) {
    ThreadContact &one = contacts[first + k], &next = contacts[first + k + 1];
    const Eigen::Vector3d pull = suture.tension[k] * (next.point - one.point).normalized();
    one.force += pull;
    next.force -= pull;
  }
}

}  // namespace

std::vector<ThreadContact> threadContacts(const State& state) {
  std::vector<ThreadContact> contacts;
  const std::vector<Suture>& sutures = state.procedure.sutures;
  for (std::size_t s = 0; s < sutures.size(); ++s)
    if (sutures[s].pulls()) addContacts(state, static_cast<int>(s), contacts);
  return contacts;
}

}  // namespace vibe
