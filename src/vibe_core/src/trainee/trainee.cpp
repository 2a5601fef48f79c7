#include "vibe_core/trainee/trainee.hpp"

#include <cmath>
#include <cstddef>
#include <deque>
#include <set>
#include <utility>
#include <variant>

// GCC 14 warns in this header: it does not see what its constructor writes on the new stack
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#endif
#include <boost/coroutine2/coroutine.hpp>
#include <boost/coroutine2/protected_fixedsize_stack.hpp>
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic pop
#endif

#include "trainee/operator.hpp"
#include "vibe_core/program/error.hpp"

namespace vibe {

namespace {

// The goals run in a coroutine: code that reads as what a person does, one thing after the other, and that gives way to
// the simulator between steps.
using Coroutine = boost::coroutines2::coroutine<void>;

std::shared_ptr<const Model> withScope(std::shared_ptr<const Model> model) {
  if (model->tool) return model;
  throw Error("The scene '" + model->scene.name + "' has no scope, which a trainee needs; add a section 'scope'.");
}

constexpr const char* kCancelled = "cancelled";
// Of the coroutine [bytes]: factors of the axis' equations keep up to 0.4 MB there (EIGEN_STACK_ALLOCATION_LIMIT); the
// default of 128 KB is too little for 16,000 particles. What is not used takes no memory.
constexpr std::size_t kStack = 4 << 20;

/// Leaves the actions of a goal that is given up.
struct Cancelled {};

}  // namespace

struct Trainee::Impl {
  Impl(std::shared_ptr<const Model> shared, const Skill& given, std::uint64_t seed, Trainee& owner)
      : model(std::move(shared)),
        skill(given),
        tremor(skill.tremor, seed),
        hand(*model, skill, [this] { endStep(); }),
        me{hand, seed, [this](const std::string& what) { say(what); }, {}},
        trainee(owner),
        delay(std::lround(skill.reaction_time / model->scene.step_period)) {}

  /// Between images the wall is where it was seen last.
  void perceive(Observation&& now) {
    if (now.wall.empty()) now.wall = std::move(seen.wall);
    seen = std::move(now);
  }

  void say(const std::string& what) {
    activity = what;
    if (trainee.on_activity) trainee.on_activity(what);
  }

  void endStep() {
    (*pause)();
    if (!draws_back && cancelled.erase(number()) > 0) throw Cancelled{};
  }

  int number() const { return static_cast<int>(results.size()); }

  GoalResult attempt(const Goal& goal) {
    me.bites_taken = 0;
    GoalResult result = endOf(goal);
    result.bites_taken = me.bites_taken;
    return result;
  }

  GoalResult endOf(const Goal& goal) {
    if (cancelled.erase(number()) > 0) return {false, kCancelled};
    say(describe(goal));
    try {
      return std::visit([this](const auto& g) { return perform(g, me); }, goal);
    } catch (const Error& error) {  // of the library, such as an organ without landmarks
      return {false, error.what()};
    } catch (const Cancelled&) {  // a coroutine must not be left from here
    }
    drawBack();
    return {false, kCancelled};
  }

  void drawBack() {
    draws_back = true;
    for (const Button button : {ApcPedal, HelixGrab, Needle, TTag, Cinch}) hand.release(button);
    stepBack(me);
    cancelled.erase(number());  // again, meanwhile
    draws_back = false;
  }

  void pursue() {
    while (true) {
      if (results.size() == goals.size()) {
        (*pause)();
        continue;
      }
      const Goal goal = goals[results.size()];
      results.push_back(attempt(goal));
      if (trainee.on_result) trainee.on_result(static_cast<int>(results.size()) - 1, results.back());
    }
  }

  void resume() {
    if (body) {
      (*body)();
      return;
    }
    boost::coroutines2::protected_fixedsize_stack stack(kStack);
    body = std::make_unique<Coroutine::pull_type>(stack, [this](Coroutine::push_type& sink) {
      pause = &sink;
      pursue();
    });
  }

  std::shared_ptr<const Model> model;
  Skill skill;
  Tremor tremor;
  TraineeHand hand;
  Operator me;
  Trainee& trainee;
  long delay;

  Observation seen;
  std::vector<Goal> goals;
  std::vector<GoalResult> results;
  std::set<int> cancelled;  // numbers of goals to be given up
  bool draws_back = false;  // after a goal that was given up
  std::string activity;
  std::deque<StepInput> decided;  // inputs on their way to the hand
  Coroutine::push_type* pause = nullptr;
  std::unique_ptr<Coroutine::pull_type> body;  // last, so that it ends first
};

Trainee::Trainee(std::shared_ptr<const Model> model, const Skill& skill, std::uint64_t seed)
    : impl_(std::make_unique<Impl>(withScope(std::move(model)), skill, seed, *this)) {}

Trainee::~Trainee() = default;

int Trainee::add(const Goal& goal) {
  const Model& model = *impl_->model;
  if (std::holds_alternative<SurveyGoal>(goal) && !impl_->me.coverage)
    impl_->me.coverage = std::make_shared<WallCoverage>(model, model.scene.inspection.value_or(InspectionScene{}));
  impl_->goals.push_back(goal);
  return static_cast<int>(impl_->goals.size()) - 1;
}

void Trainee::cancel(int number) {
  if (number >= current()) impl_->cancelled.insert(number);
}

StepInput Trainee::next(Observation seen) {
  Impl& me = *impl_;
  me.perceive(std::move(seen));
  if (me.seen.wall.empty()) {  // it acts from the first image on
    StepInput still;
    still.joints = me.seen.joints;
    return still;
  }
  me.hand.perceive(me.seen);
  lookAround(me.me);
  if (me.decided.empty()) me.decided.assign(static_cast<std::size_t>(me.delay), me.hand.command());
  me.resume();
  me.decided.push_back(me.hand.command());
  StepInput input = me.decided.front();
  me.decided.pop_front();
  for (int j = 0; j < kJointCount; ++j) input.joints[j] += me.tremor.at(j, me.seen.time);
  return input;
}

bool Trainee::done() const {
  return impl_->results.size() == impl_->goals.size();
}

int Trainee::current() const {
  return static_cast<int>(impl_->results.size());
}

const std::string& Trainee::activity() const {
  return impl_->activity;
}

const std::vector<Goal>& Trainee::goals() const {
  return impl_->goals;
}

const std::vector<GoalResult>& Trainee::results() const {
  return impl_->results;
}

namespace {

int countReached(const Trainee& trainee) {
  int count = 0;
  for (const GoalResult& result : trainee.results()) count += result.reached ? 1 : 0;
  return count;
}

int countAsPlanned(const Trainee& trainee, const std::vector<SetSkill>& sets) {
  std::size_t k = 0;
  int count = 0;
  for (const Goal& goal : trainee.goals()) {
    const auto* planned = std::get_if<SutureSetGoal>(&goal);
    if (planned == nullptr || k >= sets.size()) continue;
    if (sets[k].named && sets[k].technique == planned->pattern) ++count;
    ++k;
  }
  return count;
}

int bitesOf(const Goal& goal) {
  if (const auto* set = std::get_if<SutureSetGoal>(&goal)) return set->bites;
  return std::holds_alternative<BiteGoal>(goal) ? 1 : 0;
}

int countPlannedBites(const Trainee& trainee) {
  int count = 0;
  for (std::size_t k = 0; k < trainee.results().size(); ++k) count += bitesOf(trainee.goals()[k]);
  return count;
}

int countTakenBites(const Trainee& trainee) {
  int count = 0;
  for (const GoalResult& result : trainee.results()) count += result.bites_taken;
  return count;
}

}  // namespace

std::vector<GoalOutcome> goalOutcomes(const Trainee& trainee) {
  std::vector<GoalOutcome> outcomes;
  const std::vector<GoalResult>& results = trainee.results();
  for (std::size_t k = 0; k < trainee.goals().size(); ++k) {
    const GoalResult result = k < results.size() ? results[k] : GoalResult{false, "not ended"};
    outcomes.push_back({describe(trainee.goals()[k]), result.reached, result.reason});
  }
  return outcomes;
}

std::vector<Measure> goalMeasures(const Trainee* trainee, const std::vector<SetSkill>& sets) {
  std::vector<Measure> measures;
  const auto add = [&](const char* name, const auto& count) {
    measures.push_back({name, "1", {}});
    if (trainee != nullptr) measures.back().value = static_cast<double>(count());
  };
  add("goals", [&] { return trainee->goals().size(); });
  add("goals_reached", [&] { return countReached(*trainee); });
  add("sets_as_planned", [&] { return countAsPlanned(*trainee, sets); });
  add("bites_planned", [&] { return countPlannedBites(*trainee); });
  add("bites_given_up", [&] { return countPlannedBites(*trainee) - countTakenBites(*trainee); });
  return measures;
}

}  // namespace vibe
