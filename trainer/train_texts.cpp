// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/trainer/train_texts.h"

#include <array>
#include <cmath>
#include <utility>

namespace artus {
namespace {

struct Words {
  const char* english;
  const char* french;
};

// clang-format off
constexpr auto kCount = static_cast<std::size_t>(Said::n_said);
constexpr std::array<Words, kCount> kSaid{{
  {"Who trains?", "Qui s'exerce ?"},
  {"Records know people by a pseudonym only.", "Les dossiers ne connaissent que des pseudonymes."},
  {"Someone new", "Quelqu'un de nouveau"},
  {"{} attempts, {} passed; last: {}", "{} essais, {} réussis ; dernier : {}"},
  {"Your pseudonym is {}", "Votre pseudonyme : {}"},
  {"Note it: it is how you find your attempts again. Nothing else about you is kept.", "À noter : il permet de retrouver vos essais. Rien d'autre n'est gardé sur vous."},
  {"Go on", "Continuer"},
  {"What do you want to do, {}?", "Que voulez-vous faire, {} ?"},
  {"level {}", "niveau {}"},
  {"{} attempts, {} passed; best score {}", "{} essais, {} réussis ; meilleur score {}"},
  {"passed", "réussi"},
  {"new", "nouveau"},
  {"Time: {} s", "Temps : {} s"},
  {"Probe {}, needle {} G of {} mm", "Sonde {}, aiguille {} G de {} mm"},
  {"Probe {}", "Sonde {}"},
  {"Draw back first, then give {} ml of {} at {} ml/s", "Aspirer d'abord, puis injecter {} ml ({}) à {} ml/s"},
  {"Look at an earlier attempt", "Revoir un essai précédent"},
  {"The attempt is being read ...", "Lecture de l'essai ..."},
  {"Bring the tip to the point {} mm deep{}", "Amener la pointe au point situé à {} mm de profondeur{}"},
  {", {} mm to the left of the picture's middle", ", {} mm à gauche du milieu de l'image"},
  {", {} mm to the right of the picture's middle", ", {} mm à droite du milieu de l'image"},
  {" in the picture's middle", " au milieu de l'image"},
  {"Bring the tip into the {}", "Amener la pointe dans cette structure : {}"},
  {"Show, one after another: {}. Bring each to the picture's middle and rest there for 2 s", "Montrer, l'un après l'autre : {}. Amener chacun au milieu de l'image et y rester 2 s"},
  {"Show this, in the picture's middle: {}", "Montrer, au milieu de l'image : {}"},
  {"All were shown", "Tout a été montré"},
  {"What is judged", "Ce qui est jugé"},
  {"The needle goes in at the end of the probe that has the mark", "L'aiguille entre du côté repéré de la sonde"},
  {"The needle goes in at the end of the probe without the mark", "L'aiguille entre du côté de la sonde sans repère"},
  {"The picture: as it will look when the needle is there", "L'image : telle qu'elle sera, l'aiguille en place"},
  {"Your hands", "Vos mains"},
  {"{} takes the probe: the mouse slides it, the wheel turns it", "{} pour prendre la sonde : la souris la glisse, la molette la tourne"},
  {"{} takes the needle: the mouse moves and turns it, wheel or {} pushes, {} pulls", "{} pour prendre l'aiguille : la souris la déplace et l'oriente, molette ou {} pour enfoncer, {} pour retirer"},
  {"{} puts the thumb on the plunger: the wheel then presses it", "{} met le pouce sur le piston : la molette le presse alors"},
  {"{} when the needle is out again: then it is judged", "{} une fois l'aiguille retirée : alors c'est jugé"},
  {"It ends by itself when all are shown, or with {}", "Fin quand tout est montré, ou avec {}"},
  {"Begin", "Commencer"},
  {"Begin with aids", "Commencer avec les aides"},
  {"Begin without aids: only that counts", "Commencer sans aide : cela seul compte"},
  {"Nothing passes while aids are on; each success makes them fainter.", "Rien n'est réussi avec des aides ; chaque succès les affaiblit."},
  {"Ask: which side is it?", "Demander : quel côté ?"},
  {"Ask: any allergies?", "Demander : des allergies ?"},
  {"Ask: do you agree to it?", "Demander : êtes-vous d'accord ?"},
  {"The left one, please.", "Le gauche, s'il vous plaît."},
  {"The right one, please.", "Le droit, s'il vous plaît."},
  {"This one.", "Celui-ci."},
  {"None that I know of.", "Aucune que je sache."},
  {"Yes, go ahead.", "Oui, allez-y."},
  {"asked", "demandé"},
  {"asked which side", "côté demandé"},
  {"asked about allergies", "allergies demandées"},
  {"asked for consent", "accord demandé"},
  {"needle in", "aiguille entrée"},
  {"tip seen", "pointe vue"},
  {"tip in place", "pointe en place"},
  {"liquid given", "liquide injecté"},
  {"needle out again", "aiguille retirée"},
  {"{} s of {}", "{} s sur {}"},
  {"A gel block: it says nothing.", "Un bloc de gel : il ne dit rien."},
  {"The patient lies still.", "Le patient ne bouge pas."},
  {"I feel the prick.", "Je sens la piqûre."},
  {"Ow! That is the bone.", "Aïe ! C'est l'os."},
  {"It shoots down my arm!", "Ça lance dans le bras !"},
  {"That hurts!", "Ça fait mal !"},
  {"Is it done soon?", "C'est bientôt fini ?"},
  {"The body is being prepared ...", "Préparation du corps ..."},
  {"The attempt is being measured ...", "Mesure de l'essai ..."},
  {"Passed", "Réussi"},
  {"Not passed", "Pas encore réussi"},
  {"Not passed: aids were on", "Pas réussi : il y avait des aides"},
  {"Score {} of 100, {} s", "Score {} sur 100, {} s"},
  {"Marks", "Critères"},
  {"held", "atteint"},
  {"missed", "manqué"},
  {"not known", "inconnu"},
  {"What went wrong, the worst first", "Ce qui n'allait pas, le pire d'abord"},
  {"Well done: {}", "Bien : {}"},
  {"Report: {}", "Rapport : {}"},
  {"Look at it again", "Revoir l'essai"},
  {"Once more", "Encore une fois"},
  {"Next: {}", "Ensuite : {}"},
  {"Another task", "Un autre exercice"},
  {"Someone else", "Quelqu'un d'autre"},
  {"Leave", "Quitter"},
  {"{}: {}", "{} : {}"},
  {"at most {}", "au plus {}"},
  {"less than {}", "moins de {}"},
  {"exactly {}", "exactement {}"},
  {"at least {}", "au moins {}"},
  {"more than {}", "plus de {}"},
  {"The tip is in: {}. It lies {} mm beside the picture's plane, whose slice is {} mm thick to either side there", "La pointe est dans : {}. Elle est à {} mm du plan de l'image, dont l'épaisseur y est de {} mm de chaque côté"},
  {"It can be seen.", "Elle est visible."},
  {"It cannot be seen: the probe does not touch there.", "Elle n'est pas visible : la sonde ne touche pas à cet endroit."},
  {"It cannot be seen: the beam passes beside it.", "Elle n'est pas visible : le faisceau passe à côté."},
  {"It cannot be seen: it is beside or below the picture.", "Elle n'est pas visible : elle est à côté ou sous l'image."},
  {"It cannot be seen: it lies in the shadow of the {}.", "Elle n'est pas visible : elle est dans l'ombre de cette structure : {}."},
  {"It cannot be seen: at {} degrees to the face the echo goes elsewhere ({} dB over muscle).", "Elle n'est pas visible : à {} degrés de la face, l'écho part ailleurs ({} dB au-dessus du muscle)."},
  {"The review is being prepared ...", "Préparation de la revue ..."},
}};

struct MetricWords {
  const char* metric;
  Words words;
};
constexpr std::array<MetricWords, 27> kMetricWords{{
  {"found", {"structures shown", "structures montrées"}},
  {"find_s", {"time until all were shown, s", "temps pour tout montrer, s"}},
  {"distance_mm", {"tip from the target, mm", "pointe à la cible, mm"}},
  {"plane_offset_p90_mm", {"tip beside the picture's plane, mm", "pointe hors du plan de l'image, mm"}},
  {"unseen_advances", {"times advanced without seeing the tip", "avancées sans voir la pointe"}},
  {"unseen_mm", {"advanced without seeing the tip, mm", "avancé sans voir la pointe, mm"}},
  {"passes", {"passes of the needle", "passages de l'aiguille"}},
  {"redirections", {"turns of the needle inside", "réorientations de l'aiguille"}},
  {"time_s", {"time with the needle in, s", "temps aiguille entrée, s"}},
  {"bone_contacts", {"touches of bone", "contacts osseux"}},
  {"bone_peak_n", {"force on bone, N", "force sur l'os, N"}},
  {"avoid_fatal", {"times in what must never be entered", "entrées interdites"}},
  {"avoid_entries", {"times in what must be spared", "entrées dans ce qui doit être épargné"}},
  {"avoid_depth_mm", {"deep in what must be spared, mm", "profondeur dans ce qui doit être épargné, mm"}},
  {"avoid_time_s", {"time in what must be spared, s", "temps dans ce qui doit être épargné, s"}},
  {"entry_offset_mm", {"entry beside its place, mm", "entrée à côté de sa place, mm"}},
  {"entry_angle_deg", {"needle to the probe's face at the entry, degrees", "aiguille à la face de la sonde à l'entrée, degrés"}},
  {"in_plane_fraction", {"share of the way in the picture's plane", "part du trajet dans le plan"}},
  {"tip_seen", {"share of the time with the tip in sight", "part du temps avec la pointe en vue"}},
  {"tip_visible", {"share of the pictures that show the tip", "part des images qui montrent la pointe"}},
  {"drift_mm_s", {"probe's motion while needling, mm/s", "mouvement de la sonde pendant le geste, mm/s"}},
  {"given_ml", {"volume given, ml", "volume injecté, ml"}},
  {"in_target", {"share of the volume in the target", "part du volume dans la cible"}},
  {"flow_peak_ml_s", {"fastest flow, ml/s", "débit maximal, ml/s"}},
  {"pressure_peak_kpa", {"largest pressure, kPa", "pression maximale, kPa"}},
  {"plunger_peak_n", {"largest force of the thumb, N", "force maximale du pouce, N"}},
  {"aspirated_first", {"aspirated before giving", "aspiration avant l'injection"}},
}};

struct StepWords {
  const char* step;
  Said words;
};
constexpr std::array<StepWords, 8> kStepWords{{
  {"ask:side", Said::step_ask_side}, {"ask:allergy", Said::step_ask_allergy}, {"ask:consent", Said::step_ask_consent},
  {"auto:entry", Said::step_entry}, {"auto:tip_seen", Said::step_tip_seen}, {"auto:placed", Said::step_placed},
  {"auto:injected", Said::step_injected}, {"auto:withdrawn", Said::step_withdrawn},
}};
// clang-format on

const char* in_language(Language language, const Words& words) noexcept {
  return language == Language::french ? words.french : words.english;
}

}  // namespace

const char* said(Language language, Said which) noexcept {
  return in_language(language, kSaid[static_cast<std::size_t>(which)]);
}

std::string metric_words(Language language, const std::string& metric) {
  const std::size_t colon = metric.find(':');
  for (const MetricWords& known : kMetricWords) {
    if (metric.substr(0, colon) != known.metric) continue;
    const std::string of = colon == std::string::npos ? "" : " (" + metric.substr(colon + 1) + ")";
    return in_language(language, known.words) + of;
  }
  return metric;
}

std::string bound_words(Language language, const Mark& mark) {
  constexpr std::array<Said, 5> kRelations{Said::relation_less, Said::relation_at_most,
                                           Said::relation_equal, Said::relation_at_least,
                                           Said::relation_more};
  static_assert(static_cast<int>(Mark::Relation::less) == 0 &&
                static_cast<int>(Mark::Relation::more) == 4);
  const double tenths = 10 * mark.bound;
  const int decimals = mark.bound == std::round(mark.bound) ? 0
                       : tenths == std::round(tenths)       ? 1
                                                            : 2;
  return fill(said(language, kRelations.at(static_cast<std::size_t>(mark.relation))),
              {number(language, mark.bound, decimals)});
}

std::string mark_words(Language language, const Mark& mark) {
  return fill(said(language, Said::colon),
              {metric_words(language, mark.metric), bound_words(language, mark)});
}

const std::string& title_words(Language language, const Scenario& scenario) {
  const bool french = language == Language::french && !scenario.title_fr.empty();
  return french ? scenario.title_fr : scenario.title;
}

std::string step_words(Language language, const std::string& step) {
  for (const StepWords& known : kStepWords)
    if (step == known.step) return said(language, known.words);
  return step;
}

}  // namespace artus
