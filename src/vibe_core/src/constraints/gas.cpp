#include "vibe_core/constraints/gas.hpp"

#include <algorithm>

#include "constraints/blocks.hpp"
#include "geometry/surface_operators.hpp"
#include "vibe_core/model/model.hpp"
#include "vibe_core/state/state.hpp"

namespace vibe {

namespace {
constexpr double kSmallestVolume = 1e-9;  // a cubic millimetre: the pressure of a collapsed lumen stays finite [m^3]
}

double gaugePressure(double amount, double volume) {
  return amount / std::max(volume, kSmallestVolume) - kAmbientPressure;
}

double gasAmount(double gauge_pressure, double volume) {
  return (kAmbientPressure + gauge_pressure) * volume;
}

GasRange insufflatorRange(const GasScene& gas, double amount, double dt) {
  const double limit = gas.flow_limit * kAmbientPressure * dt;
  return {std::max(0.0, amount - limit), amount + limit};
}

double insufflate(const GasScene& gas, double amount, double volume, double dt) {
  const GasRange range = insufflatorRange(gas, amount, dt);
  return std::clamp(gasAmount(gas.regulated_pressure, volume), range.min, range.max);
}

namespace {

class GasBlock : public ConstraintBlock {
 public:
  Activity prepare(const StepContext& context, BodyLoads& loads) override {
    loads.gas.control = context.insufflator_on ? GasLoad::Control::Regulated : GasLoad::Control::Amount;
    return context.insufflator_on ? Activity::Disturb : Activity::Sleep;
  }

  void begin(const StepContext& context, BodyLoads& loads) override {
    const State& state = context.state;
    const GasScene& scene = *context.model.scene.gas;
    const GasRange range = insufflatorRange(scene, state.gas_amount, context.step);
    loads.gas.amount = state.gas_amount;
    loads.gas.amount_min = range.min;
    loads.gas.amount_max = range.max;
    loads.gas.set_pressure = scene.regulated_pressure;
    loads.gas.ambient = kAmbientPressure;
    loads.gas.volume = state.volume;
  }

  double store(const StepContext& context, const BodyLoads&, std::vector<ToolTouch>&) override {
    measure(context);
    return 0;
  }
  void recover(const StepContext& context) override { measure(context); }

 private:
  void measure(const StepContext& context) const {
    State& state = context.state;
    state.volume = lumenVolume(context.model.organ.surface, state.x, state.y, state.z);
    if (context.insufflator_on)
      state.gas_amount = insufflate(*context.model.scene.gas, state.gas_amount, state.volume, context.step);
    state.pressure = gaugePressure(state.gas_amount, state.volume);
  }
};

}  // namespace

std::unique_ptr<ConstraintBlock> makeGasBlock(const Model& model) {
  return model.scene.gas ? std::make_unique<GasBlock>() : nullptr;
}

}  // namespace vibe
