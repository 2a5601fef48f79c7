#include "constraints/thread_loads.hpp"

namespace vibe {

namespace {

Eigen::Vector3d positionOf(const AttachmentPoint& attachment, const State& state) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < attachment.node.size(); ++i) {
    const int p = attachment.node[i];
    sum += attachment.weight[i] * Eigen::Vector3d(state.x[p], state.y[p], state.z[p]);
  }
  return sum;
}

void addSuture(const SutureScene& scene, const Suture& suture, int first_attachment, BodyLoads& loads,
               ThreadLoad& thread) {
  thread.first_attachment = first_attachment;
  thread.length = suture.length;
  thread.tension = suture.tension;
  thread.tension.resize(suture.length.size(), 0.0);
  thread.stiffness = scene.thread_stiffness;
  thread.friction = scene.thread_friction;
  for (std::size_t b = 0; b < suture.bites.size(); ++b) {
    AttachmentPoint& attachment = loads.attachments[static_cast<std::size_t>(first_attachment) + b];
    attachment.node = suture.bites[b].particle;
    attachment.weight = suture.bites[b].weight;
  }
}

}  // namespace

void fillThreads(const Model& model, const State& state, BodyLoads& loads) {
  std::size_t threads = 0, attachments = 0;
  if (model.scene.suture && model.scene.suture->cinch_model == "thread")
    for (const Suture& suture : state.procedure.sutures)
      if (suture.pulls()) ++threads, attachments += suture.bites.size();
  loads.threads.resize(threads);
  loads.attachments.resize(attachments);
  if (threads == 0) return;
  threads = 0, attachments = 0;
  for (const Suture& suture : state.procedure.sutures) {
    if (!suture.pulls()) continue;
    addSuture(*model.scene.suture, suture, static_cast<int>(attachments), loads, loads.threads[threads++]);
    attachments += suture.bites.size();
  }
}

void storeThreads(const BodyLoads& loads, State& state) {
  if (loads.threads.empty()) return;
  std::size_t t = 0;
  for (Suture& suture : state.procedure.sutures) {
    if (!suture.pulls()) continue;
    suture.length = loads.threads[t].length;
    suture.tension = loads.threads[t++].tension;
  }
}

void segmentLengths(const BodyLoads& loads, const State& state, std::vector<double>& lengths) {
  lengths.clear();
  for (const ThreadLoad& thread : loads.threads)
    for (std::size_t k = 0; k < thread.length.size(); ++k) {
      const std::size_t attachment = static_cast<std::size_t>(thread.first_attachment) + k;
      lengths.push_back(
          (positionOf(loads.attachments[attachment + 1], state) - positionOf(loads.attachments[attachment], state))
              .norm());
    }
}

double threadWork(const BodyLoads& loads, const State& state, const std::vector<double>& before,
                  const std::vector<double>& after) {
  double work = 0;
  std::size_t t = 0, segment = 0;
  for (const Suture& suture : state.procedure.sutures) {
    if (loads.threads.empty() || !suture.pulls()) continue;
    const ThreadLoad& thread = loads.threads[t++];
    for (std::size_t k = 0; k < thread.tension.size(); ++k, ++segment) {
      const double old = k < suture.tension.size() ? suture.tension[k] : 0;
      work -= 0.5 * (old + thread.tension[k]) * (after[segment] - before[segment]);
    }
  }
  return work;
}

}  // namespace vibe
