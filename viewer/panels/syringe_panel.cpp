// SPDX-License-Identifier: AGPL-3.0-or-later
#include <array>
#include <string>

#include "artus/detail/core/units.h"
#include "artus/detail/viewer/panels/panels.h"
#include "artus/detail/viewer/panels/shade.h"
#include "artus/detail/viewer/words/anatomy_names.h"

namespace artus {
namespace {

constexpr Shade kRead{0.85F, 0.85F, 0.85F};
constexpr Shade kComplains{1, 0.55F, 0.4F};

}  // namespace

void draw_syringe(const PanelInput& in, const ViewState& state) {
  const SyringeReading& syringe = in.syringe;
  if (!syringe.used) return;
  const Language language = state.language;
  wrapped_text(fill(translate(state, "syringe: {} ml left, {} injected, {} ml/s"),
                    {number(language, syringe.left / kCubicCentimetre, 2),
                     number(language, syringe.given / kCubicCentimetre, 2),
                     number(language, syringe.flow / kCubicCentimetre, 2)}),
               kRead);
  wrapped_text(
      fill(translate(state, "thumb {} N, {} kPa at the tip"),
           {number(language, syringe.thumb, 1), number(language, 1e-3 * syringe.pressure, 0)}),
      kRead);
  if (!(syringe.drawn > 0)) return;
  const std::string own = syringe.own.empty() ? translate(state, "the patient's own")
                                              : clinical_name(language, std::string(syringe.own));
  wrapped_text(fill(translate(state, "drawn back into the syringe: {} ml of {}"),
                    {number(language, syringe.drawn / kCubicCentimetre, 2), own}),
               kRead);
}

void draw_patient_words(const PanelInput& in, const ViewState& state) {
  constexpr std::array<const char*, 6> kWords{
      msgid("Ow! It shoots down my arm."),  msgid("Something gave way."),
      msgid("My heart is racing."),         msgid("That hurts."),
      msgid("That is too fast, it burns."), msgid("I feel pressure.")};
  if (in.syringe.patient == PatientFeeling::nothing) return;
  wrapped_text(translate(state, kWords.at(static_cast<std::size_t>(in.syringe.patient) - 1)),
               kComplains);
}

}  // namespace artus
