#include "diagnosis/effects/effect_model.hpp"

namespace snag {

CaseFeatures any_of(CaseFeatures a, const CaseFeatures& b) {
  a.prescribed = a.prescribed && b.prescribed;
  for (bool CaseFeatures::*fact :
       {&CaseFeatures::wall, &CaseFeatures::gravity, &CaseFeatures::flows, &CaseFeatures::uniform, &CaseFeatures::varies,
        &CaseFeatures::gradient, &CaseFeatures::turbulence, &CaseFeatures::bonds, &CaseFeatures::sheet, &CaseFeatures::fibre,
        &CaseFeatures::several, &CaseFeatures::oriented, &CaseFeatures::hertz, &CaseFeatures::pipe, &CaseFeatures::bend,
        &CaseFeatures::crumple, &CaseFeatures::averaging})
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

void RunEdit::move_pieces(const Vec3& way) {
  for (const char* key : piece_places) add(key, way);
}

void RunEdit::spin_pieces(const Vec3& spin) {
  for (const char* key : piece_spins) add(key, spin);
}

Registry<EffectModel>& effect_models() {
  static Registry<EffectModel> registry("effect");
  return registry;
}

}  // namespace snag
