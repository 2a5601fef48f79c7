#include "vibe_core/trainee/esg_plan.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "common/random.hpp"
#include "procedure/thread_events.hpp"
#include "trainee/ik_solution.hpp"
#include "vibe_core/common/error.hpp"

namespace vibe {

namespace {

constexpr double kHelixOut = 26e-3;   // helix_advance while it is screwed in [m]
constexpr double kHelixHome = 2e-3;   // [m]
constexpr double kStandOff = 10e-3;   // gap between helix and wall before contact [m]
constexpr double kNear = 3e-3;        // gap within reach of the helix, with a margin [m]
constexpr double kInto = 1.5e-3;      // depth into the wall, so that it is surely in reach [m]
constexpr double kBeamGap = 3e-3;     // from the probe to the wall [m]
constexpr double kFill = 9;           // time to insufflate [s]
constexpr double kLongestCinch = 12;  // [s]
constexpr double kTurn = 6.283185307179586;

struct Target {
  double along = 0, angle = 0;
};

class EsgPlanResult {
 public:
  EsgPlanResult(const EsgStyle& style, ScriptRecorder& hand, const std::function<void(const std::string&)>& progress)
      : style_(style), hand_(hand), progress_(progress), random_(style.seed) {
    const Model& model = hand.model();
    const Scene& scene = model.scene;
    if (!scene.scope || !scene.gas || !scene.helix || !scene.suture)
      throw Error("The scene '" + scene.name + "' lacks scope, gas, helix or suture; a sleeve needs all four.");
    for (int i = 0; i < model.particle_count; ++i) {
      if (model.organ.region[i] != Region::Body || model.organ.wall[i] != Wall::GreaterCurvature) continue;
      proximal_ = std::min(proximal_, model.along[i]);
      distal_ = std::max(distal_, model.along[i]);
    }
    hand_.pace = style.pace;
  }

  void perform() {
    say("insert and insufflate");
    hand_.move(Insertion, 0.06, 1);
    hand_.act("{press: insufflate}");
    hand_.wait(kFill);
    if (style_.marks > 0 && hand_.model().scene.marking) mark();
    for (int set = 0; set < style_.sets; ++set) {
      if (style_.only_set > 0 && set != style_.only_set - 1) continue;
      for (int bite = 0; bite < style_.bites; ++bite) takeBite(set, bite);
      finishSet(set);
    }
    say("withdraw");
    goBack();
    hand_.move(Insertion, 0.0, 1);
    hand_.wait(1);
    hand_.act("{release: insufflate}");
    hand_.wait(0.5);
  }

 private:
  void say(const std::string& what) {
    hand_.phase(what);
    progress_(what);
  }

  double nextNormal() {
    double sum = -6;
    for (int k = 0; k < 12; ++k) sum += nextUniform(random_);
    return sum;
  }

  WallPlace aimed(const Target& target) {
    const int particle = particleAt(hand_.model(), target.along, target.angle);
    if (particle < 0) throw Error("The organ has no wall where the sleeve is to be; check its landmarks.");
    return placeOf(hand_.model(), hand_.state(), particle);
  }

  // Distance from the tip of the helix to the nearest particle [m].
  double helixGap() const {
    const Model& model = hand_.model();
    const State& state = hand_.state();
    std::vector<Eigen::Isometry3d> poses;
    model.tool->forwardKinematics(state.joints, state.tool_displacement, poses);
    const Eigen::Vector3d tip = model.tool_base * poses[model.helix_link].translation();
    double min = 1;
    for (int i = 0; i < model.particle_count; ++i)
      min = std::min(min, (Eigen::Vector3d(state.x[i], state.y[i], state.z[i]) - tip).norm());
    return min;
  }

  void mark() {
    const double spread = style_.mark_spread > 0 ? style_.mark_spread : style_.spread;
    const double angles[] = {spread, 0, -spread};
    const char* const names[] = {"mark the anterior wall", "mark the greater curvature", "mark the posterior wall"};
    for (int line = 0; line < 3; ++line) {
      say(names[line]);
      for (int k = 0; k < style_.marks; ++k)
        markAt({between((k + 0.5) / style_.marks), angles[line]}, line * style_.marks + k == style_.burnt_mark);
      goBack();
    }
  }

  void markAt(const Target& target, bool burnt) {
    const double probe = hand_.model().scene.marking ? hand_.model().scene.marking->apc.probe_length : 0;
    for (const double off : {0.02, 0.0}) {
      const WallPlace place = aimed(target);
      const IkSolution aim = aimAt(hand_.model(), place.point - (probe + kBeamGap + off) * place.outward, place.outward,
                                   Eigen::Vector3d::Zero(), hand_.joints());
      hand_.moveTo(aim.joints, off > 0 ? 0.5 : 0.3);
    }
    hand_.hold(ApcPedal, burnt && style_.burn_time > 0 ? style_.burn_time : style_.mark_time);
  }

  // Distal first: 0 is the distal end.
  double between(double part) const {
    const double from = style_.distal_first ? distal_ : proximal_, to = style_.distal_first ? proximal_ : distal_;
    return from + part * (to - from);
  }

  // A U of two rows across the greater curvature; the bites in between form the bend.
  Target bitePlace(int set, int bite) const {
    const int row = (style_.bites - 1) / 2;  // bites per row
    const double pitch = 1.0 / style_.sets;
    const double first = (set + 0.25) * pitch, second = (set + 0.75) * pitch;
    const auto angle = [&](int k) { return style_.spread * (1 - 2.0 * k / std::max(1, row - 1)); };
    if (bite < row) return {between(first), angle(bite)};
    const int turn = style_.bites - 2 * row;
    if (bite < row + turn) return {between(first + (second - first) * (bite - row + 1) / (turn + 1)), -style_.spread};
    return {between(second), -angle(bite - row - turn)};
  }

  void takeBite(int set, int bite) {
    say("set " + std::to_string(set + 1) + " bite " + std::to_string(bite + 1));
    for (int attempt = 0; attempt < style_.attempts; ++attempt)
      if (tryBite(bitePlace(set, bite))) return;
  }

  bool tryBite(const Target& target) {
    bool bitten = false;
    if (grab(target)) {
      const std::vector<double> draws =
          style_.looks ? std::vector<double>{style_.drawn, 0.2 * style_.drawn} : std::vector<double>{style_.drawn};
      for (const double drawn : draws)
        if (!bitten) bitten = closeArmAt(drawn, drawn == draws.back());
      hand_.move(HelixAdvance, kHelixOut - 4e-3, 0.6);
    }
    letGo();
    if (bitten && hand_.state().procedure.needle_loaded && !hand_.state().procedure.needle_on_arm) returnNeedle();
    return bitten;
  }

  // Exchanges the needle if it has penetrated the full wall. On the last attempt, any bite is accepted.
  bool closeArmAt(double drawn, bool last) {
    hand_.move(HelixAdvance, drawn, 0.8);
    if (hand_.state().grip.empty()) return false;
    hand_.move(NeedleDriver, 0.018, 0.3);
    const ProcedureState& procedure = hand_.state().procedure;
    bool bitten = false;
    if (procedure.pierced && (last || procedure.pending.fullThickness())) {
      hand_.hold(Needle, 0.12);
      bitten = hand_.happened(Event::Kind::Bite);
    }
    hand_.move(NeedleDriver, 0.0, 0.3);
    return bitten;
  }

  bool grab(const Target& target) {
    const Eigen::Vector3d helix(kHelixOut - 2e-3, 2.8e-3, -2.2e-3);
    const Eigen::Vector3d error = style_.aim_error * Eigen::Vector3d(nextNormal(), nextNormal(), nextNormal());
    for (const double into : {-kStandOff, kInto, 2 * kInto, 4 * kInto}) {  // the wall yields: follow it if necessary
      if (into > kInto && helixGap() < kNear) break;
      const WallPlace place = aimed(target);
      std::array<double, kJointCount> joints =
          aimAt(hand_.model(), place.point + error + into * place.outward, place.outward, helix, hand_.joints()).joints;
      joints[HelixAdvance] = kHelixOut;
      hand_.moveTo(joints, into < 0 ? 0.5 : 0.3);
    }
    hand_.act("{press: helix_grab}");
    hand_.move(HelixRotation, style_.turns * kTurn, 0.8);
    return !hand_.state().grip.empty();
  }

  // Removes the helix from the wall, then retracts a little.
  void letGo() {
    hand_.act("{release: helix_grab}");
    std::array<double, kJointCount> joints = hand_.joints();
    joints[HelixAdvance] = kHelixHome;
    joints[HelixRotation] = 0;
    joints[Insertion] = std::max(0.0, joints[Insertion] - 8e-3);
    hand_.moveTo(joints, 0.8);
  }

  void returnNeedle() {
    for (int attempt = 0; attempt < 3 && !hand_.state().procedure.needle_on_arm; ++attempt) {
      hand_.move(NeedleDriver, 0.018, 0.3);
      hand_.hold(Needle, 0.12);
      hand_.move(NeedleDriver, 0.0, 0.3);
    }
  }

  void goBack() {
    std::array<double, kJointCount> joints = hand_.joints();
    joints[Insertion] = 0.05;
    joints[TipUpDown] = joints[TipLeftRight] = 0;
    joints[HelixAdvance] = kHelixHome;
    hand_.moveTo(joints, 1);
  }

  void finishSet(int set) {
    say("set " + std::to_string(set + 1) + " T-tag and cinch");
    if (style_.mistakes && set == 0) hand_.hold(Cinch, 0.3);  // before the T-tag
    hand_.hold(TTag, 0.15);
    if (!std::any_of(hand_.events().begin(), hand_.events().end(),
                     [](const Event& e) { return e.kind == Event::Kind::TTagDropped; }))
      return;
    goBack();
    hand_.act("{press: cinch}");
    double time = 0;
    while (time < kLongestCinch && !isTight()) hand_.wait(0.25), time += 0.25;
    hand_.act("{release: cinch}");
    hand_.wait(0.5);
  }

  bool isTight() const {
    const ProcedureState& procedure = hand_.state().procedure;
    if (procedure.sutures.empty() || procedure.sutures.back().permanent()) return true;
    return cinchTension(procedure.sutures.back()) >= style_.cinch_part * hand_.model().scene.suture->cinch_tension;
  }

  const EsgStyle& style_;
  ScriptRecorder& hand_;
  const std::function<void(const std::string&)>& progress_;
  std::uint64_t random_;
  double proximal_ = 1, distal_ = 0;
};

}  // namespace

void performEsg(const EsgStyle& style, ScriptRecorder& rehearsal,
                const std::function<void(const std::string&)>& progress) {
  EsgPlanResult(style, rehearsal, progress).perform();
}

}  // namespace vibe
