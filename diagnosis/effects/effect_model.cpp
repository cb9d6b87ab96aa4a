#include "diagnosis/effects/effect_model.hpp"

namespace snag {

BaseCase any_of(BaseCase a, const BaseCase& b) {
  a.prescribed = a.prescribed && b.prescribed;
  for (bool BaseCase::*fact :
       {&BaseCase::wall, &BaseCase::gravity, &BaseCase::flows, &BaseCase::uniform, &BaseCase::varies, &BaseCase::gradient,
        &BaseCase::turbulence, &BaseCase::bonds, &BaseCase::sheet, &BaseCase::several, &BaseCase::oriented})
    a.*fact = a.*fact || b.*fact;
  return a;
}

void RunEdit::scale_varying_flow(double factor) {
  for (const char* key : {"flow.gradient_per_s", "flow.amplitude_m_s", "initial_flow.velocity_factor"}) scale(key, factor);
}

void RunEdit::scale_flow(double factor) {
  scale_varying_flow(factor);
  if (base().prescribed) return scale("flow.velocity_m_s", factor);
  for (const char* key : set_points) scale(key, factor);
}

Registry<EffectModel>& effect_models() {
  static Registry<EffectModel> registry("effect");
  return registry;
}

}  // namespace snag
