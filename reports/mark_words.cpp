// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/reports/mark_words.h"

#include <array>
#include <cmath>
#include <utility>

#include "artus/detail/viewer/words/anatomy_names.h"

namespace artus {
namespace {

struct Named {
  const char* name;
  const char* words;
};

constexpr std::array<Named, 65> kMetrics{{
    {"asked", msgid("share of the questions that were asked")},
    {"found", msgid("structures shown")},
    {"find_s", msgid("time until all were shown, s")},
    {"distance_mm", msgid("tip from the target, mm")},
    {"plane_offset_p90_mm", msgid("tip beside the picture's plane, mm")},
    {"unseen_advances", msgid("advances without seeing the tip")},
    {"unseen_mm", msgid("advanced without seeing the tip, mm")},
    {"passes", msgid("passes of the needle")},
    {"redirections", msgid("redirections of the needle")},
    {"withdrawn", msgid("needle withdrawn at the end")},
    {"done_s", msgid("time until the needle was out, s")},
    {"time_s", msgid("time with the needle in, s")},
    {"bone_contacts", msgid("bone contacts")},
    {"bone_peak_n", msgid("force on bone, N")},
    {"avoid_fatal", msgid("entries into forbidden structures")},
    {"avoid_entries", msgid("entries into structures to avoid")},
    {"avoid_depth_mm", msgid("depth in structures to avoid, mm")},
    {"avoid_time_s", msgid("time in structures to avoid, s")},
    {"entry_offset_mm", msgid("distance from the planned entry, mm")},
    {"entry_angle_deg", msgid("angle between needle and probe face at the entry, degrees")},
    {"in_plane_fraction", msgid("share of the path in the picture's plane")},
    {"tip_seen", msgid("share of the time with the tip in sight")},
    {"tip_visible", msgid("share of the pictures that show the tip")},
    {"drift_mm_s", msgid("probe's motion while needling, mm/s")},
    {"given_ml", msgid("volume injected, ml")},
    {"in_target", msgid("share of the volume in the target")},
    {"flow_peak_ml_s", msgid("fastest flow, ml/s")},
    {"pressure_peak_kpa", msgid("largest pressure, kPa")},
    {"plunger_peak_n", msgid("largest force of the thumb, N")},
    {"aspirated_first", msgid("aspirated before injecting")},
    {"path_length_mm", msgid("path length, mm")},
    {"left_out", msgid("poses left out")},
    {"rotation_deg", msgid("rotation in all, degrees")},
    {"movements", msgid("movements")},
    {"rotations", msgid("turns")},
    {"sparc", msgid("smoothness by spectral arc length")},
    {"ldlj", msgid("smoothness by jerk")},
    {"time_to_contact_s", msgid("time before the needle went in, s")},
    {"time_in_tissue_s", msgid("time in tissue, s")},
    {"path_in_tissue_mm", msgid("path in tissue, mm")},
    {"swept_area_mm2", msgid("tissue swept by the needle, mm²")},
    {"swept_volume_mm3", msgid("tissue cut by the needle, mm³")},
    {"deepest_mm", msgid("deepest place of the tip, mm")},
    {"idle", msgid("times at rest")},
    {"idle_s", msgid("time at rest, s")},
    {"plane_offset_median_mm", msgid("tip beside the picture's plane, median, mm")},
    {"plane_angle_median_deg", msgid("needle to the picture's plane, median, degrees")},
    {"plane_angle_p90_deg", msgid("needle to the picture's plane, 90th percentile, degrees")},
    {"unseen_entry_mm", msgid("advanced before the picture's edge, mm")},
    {"doppler_before_s", msgid("Doppler before the needle, s")},
    {"face_angle_median_deg", msgid("needle to the probe's face, median, degrees")},
    {"bimanual", msgid("hands moving together")},
    {"bone_speed_mm_s", msgid("fastest touch of bone, mm/s")},
    {"bone_scratch_mm", msgid("path along bone, mm")},
    {"force_peak_n", msgid("largest force in the layer, N")},
    {"force_mean_n", msgid("mean force in the layer, N")},
    {"force_impulse_n_s", msgid("force over time in the layer, N s")},
    {"given_distance_mm", msgid("volume injected from the target, mm")},
    {"syringe_s", msgid("time with the syringe, s")},
    {"flow_mean_ml_s", msgid("mean flow, ml/s")},
    {"tip_drift_mm", msgid("tip's drift while injecting, mm")},
    {"test_dose_ml", msgid("first dose before a look, ml")},
    {"look_pauses", msgid("pauses to look")},
    {"aspirations", msgid("aspirations")},
    {"tip_contrast_median_db", msgid("tip over what is around it, median, dB")},
}};

}  // namespace

std::string metric_words(Language language, const std::string& metric) {
  const std::size_t colon = metric.find(':');
  for (const Named& known : kMetrics) {
    if (metric.substr(0, colon) != known.name) continue;
    const std::string of = colon == std::string::npos
                               ? ""
                               : " (" + clinical_name(language, metric.substr(colon + 1)) + ")";
    return translate(language, known.words) + of;
  }
  return metric;
}

std::string bound_words(Language language, const Mark& mark) {
  constexpr std::array<const char*, 5> kRelations{msgid("less than {}"), msgid("at most {}"),
                                                  msgid("exactly {}"), msgid("at least {}"),
                                                  msgid("more than {}")};
  static_assert(static_cast<int>(Mark::Relation::less) == 0 &&
                static_cast<int>(Mark::Relation::more) == 4);
  const double tenths = 10 * mark.bound;
  const int decimals = mark.bound == std::round(mark.bound) ? 0
                       : tenths == std::round(tenths)       ? 1
                                                            : 2;
  return fill(translate(language, kRelations.at(static_cast<std::size_t>(mark.relation))),
              {number(language, mark.bound, decimals)});
}

std::string mark_words(Language language, const Mark& mark) {
  return fill(translate(language, "{}: {}"),
              {metric_words(language, mark.metric), bound_words(language, mark)});
}

const std::string& title_words(Language language, const Scenario& scenario) {
  const bool french = language == Language::french && !scenario.title_fr.empty();
  return french ? scenario.title_fr : scenario.title;
}

}  // namespace artus
