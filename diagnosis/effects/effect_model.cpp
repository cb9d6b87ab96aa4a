#include "diagnosis/effects/effect_model.hpp"

namespace snag {

Registry<EffectModel>& effect_models() {
  static Registry<EffectModel> registry("effect");
  return registry;
}

}  // namespace snag
