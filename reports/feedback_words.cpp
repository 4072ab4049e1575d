// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/reports/feedback_words.h"

#include <algorithm>
#include <array>
#include <optional>
#include <string_view>
#include <vector>

#include "artus/detail/viewer/words/anatomy_names.h"

namespace artus {
namespace {

/// A sentence with holes, filled in the same order in both languages.
struct Sentence {
  std::string_view english;
  std::string_view french;
};

// clang-format off
constexpr std::array<Sentence, 61> kSentences{{
  // what, before its value
  {"into what must be spared", "dans ce qui doit être épargné"},
  {"advanced without seeing the tip", "avancé sans voir la pointe"},
  {"touches of bone", "contacts avec l'os"},
  {"away from the target", "à distance de la cible"},
  {"given beside the target", "injecté à côté de la cible"},
  {"pressure in the barrel", "pression dans la seringue"},
  {"fastest flow", "débit maximal"},
  {"needle at rest inside", "aiguille immobile à l'intérieur"},
  {"the probe moved while needling", "la sonde a bougé pendant la progression"},
  {"passes", "passages"},
  {"the needle's angle to the probe's face", "angle de l'aiguille à la face de la sonde"},
  {"degrees", "degrés"},
  {"{}: {} {}; asked for: below {}, and onto bone", "{} : {} {} ; demandé : moins de {}, et jusqu'à l'os"},
  {"{}: {} {}; asked for: below {}", "{} : {} {} ; demandé : moins de {}"},
  {"{} ml given without an aspiration before", "{} ml injectés sans aspiration préalable"},
  {"shown: {} of {}; not shown: {}", "montrées : {} sur {} ; pas montrée : {}"},
  // why
  {"it was in the picture for {} s, and not in its middle for {} s on end", "dans l'image pendant {} s, mais pas au milieu pendant {} s de suite"},
  {"it was never in the picture while it was asked for", "jamais dans l'image tant qu'elle était demandée"},
  {"the tip was not seen", "la pointe n'était pas vue"},
  {"the tip was {} mm in front of the plane", "la pointe était {} mm en avant du plan"},
  {"the tip was {} mm behind the plane", "la pointe était {} mm en arrière du plan"},
  {"the needle stood at {} degrees to the probe's face: {} dB lost to the angle", "l'aiguille était à {} degrés de la face de la sonde : {} dB perdus par l'angle"},
  {"the tip was in the shadow of {}", "la pointe était dans l'ombre de cette structure : {}"},
  {"the probe did not touch the skin above the tip", "la sonde ne touchait pas la peau au-dessus de la pointe"},
  {"the tip was beside or below the picture", "la pointe était à côté ou sous l'image"},
  {"the tip came onto bone at {} mm/s", "la pointe est arrivée sur l'os à {} mm/s"},
  {"the tip went {} mm into the zone around {}", "la pointe est entrée de {} mm dans la zone autour de cette structure : {}"},
  {"nothing moved for {} s", "rien n'a bougé pendant {} s"},
  {"the needle was placed {} mm from the target", "l'aiguille a été placée à {} mm de la cible"},
  {"both hands moved at once, the probe with {} mm/s at the fastest", "les deux mains bougeaient à la fois, la sonde à {} mm/s au plus vite"},
  {"the way was not chosen before the skin", "le trajet n'était pas choisi avant la peau"},
  {"a steep needle sends its echo away", "une aiguille raide renvoie son écho ailleurs"},
  {"{} ml with the tip in {}, and no pause to look after the first of it", "{} ml, pointe dans : {}, sans pause pour regarder après les premières gouttes"},
  {"{} ml with the tip in {}", "{} ml, pointe dans : {}"},
  {"the barrel was not drawn back for 2 s; the tip was in {}", "pas d'aspiration de 2 s ; la pointe était dans : {}"},
  {"the tip was in {}", "la pointe était dans : {}"},
  {"the thumb pushed with {} N at most", "le pouce a poussé avec {} N au plus"},
  // what to do
  {"Enter further from the probe, so that the needle lies flatter.", "Entrez plus loin de la sonde, pour une aiguille plus à plat."},
  {"Choose a way that bone does not cover.", "Choisissez un trajet que l'os ne couvre pas."},
  {"Keep the whole face on the skin.", "Gardez toute la face de la sonde sur la peau."},
  {"Stop when you lose the tip. Find the needle with the beam: move the probe, then advance.", "Arrêtez dès que vous perdez la pointe. Retrouvez l'aiguille avec le faisceau : bougez la sonde, puis avancez."},
  {"Stop when you lose the tip. Tilt the probe until it is back, then advance.", "Arrêtez dès que vous perdez la pointe. Basculez la sonde jusqu'à la revoir, puis avancez."},
  {"Slow below 5 mm/s in the last centimetre.", "Moins de 5 mm/s dans le dernier centimètre."},
  {"Before you stop, look where the tip is, not where it should be.", "Avant d'arrêter, regardez où est la pointe, non où elle devrait être."},
  {"Give half a ml and look: the line must split.", "Injectez un demi ml et regardez : la ligne doit s'ouvrir."},
  {"Pull back for 3 s before you give.", "Aspirez 3 s avant d'injecter."},
  {"Do not push on: pull back a millimetre until it flows.", "N'insistez pas : reculez d'un millimètre jusqu'à ce que ça coule."},
  {"Below 0.3 ml/s you feel the tissue.", "Sous 0,3 ml/s on sent le tissu."},
  {"Look and decide before the skin, then go.", "Regardez et décidez avant la peau, puis allez-y."},
  {"Rest the probe hand on the patient.", "Posez la main de la sonde sur le patient."},
  {"Choose the line before the skin.", "Choisissez la ligne avant la peau."},
  {"Flatter: enter further from the probe.", "Plus à plat : entrez plus loin de la sonde."},
  {"Sweep all of it slowly. Stop when it shows, bring it to the middle, and rest.", "Balayez tout, lentement. Arrêtez dès qu'elle apparaît, amenez-la au milieu et restez-y."},
  // done well
  {"You found all that was asked for.", "Vous avez trouvé tout ce qui était demandé."},
  {"You kept the tip in sight nearly all the time.", "Vous avez gardé la pointe en vue presque tout le temps."},
  {"You kept the needle in the plane while you advanced.", "Vous avez gardé l'aiguille dans le plan en avançant."},
  {"You came there in a single pass.", "Vous y êtes arrivé en un seul passage."},
  {"Your probe hand was quiet.", "Votre main de sonde était calme."},
  // what is next: those that name a scenario, and those of the same
  {"The same once more with the aids off: only that counts.", "La même chose sans les aides : cela seul compte."},
  {"Once more to make sure, then the next level.", "Encore une fois pour confirmer, puis le niveau suivant."},
  {"The same task once more.", "Le même exercice encore une fois."},
}};
constexpr std::array<Sentence, 5> kTasks{{
  {"Find the structures in the gel block with the probe ({}).", "Trouver les structures du bloc de gel avec la sonde ({})."},
  {"Follow the tip to a shallow point on the gel block ({}).", "Suivre la pointe jusqu'à un point peu profond, sur le bloc de gel ({})."},
  {"Hold the needle in the plane on the gel block ({}).", "Garder l'aiguille dans le plan, sur le bloc de gel ({})."},
  {"Touch the point at 20 mm on the gel block ({}).", "Toucher le point à 20 mm, sur le bloc de gel ({})."},
  {"The same task once more: draw back, give half a ml, look, then the rest.", "Le même exercice : aspirer, injecter un demi ml, regarder, puis le reste."},
}};
// clang-format on

/// What stands in a pattern's holes when a text is of its form.
std::optional<std::vector<std::string>> holes_of(std::string_view pattern, std::string_view text) {
  std::vector<std::string> holes;
  const std::size_t hole = pattern.find("{}");
  const std::string_view before = pattern.substr(0, hole);
  if (text.substr(0, before.size()) != before) return std::nullopt;
  text.remove_prefix(before.size());
  if (hole == std::string_view::npos) return text.empty() ? std::optional(holes) : std::nullopt;
  const std::string_view rest = pattern.substr(hole + 2);
  const std::string_view next = rest.substr(0, rest.find("{}"));
  for (std::size_t end = 0; end <= text.size(); ++end) {
    if (text.substr(end, next.size()) != next) continue;
    const auto later = holes_of(rest, text.substr(end));
    if (!later) continue;
    holes.emplace_back(text.substr(0, end));
    holes.insert(holes.end(), later->begin(), later->end());
    return holes;
  }
  return std::nullopt;
}

bool is_number(const std::string& text) {
  return !text.empty() && text.find_first_not_of("0123456789.-") == std::string::npos;
}

/// A number, a sentence or a structure in a hole.
std::string hole_words(Language language, const std::string& text) {
  std::string words = text;
  if (is_number(text)) {
    std::replace(words.begin(), words.end(), '.', ',');
    return words;
  }
  words = feedback_words(language, text);
  return words == text && text.find('/') == std::string::npos && text.size() > 3
             ? clinical_name(language, text)
             : words;
}

}  // namespace

std::string feedback_words(Language language, const std::string& english) {
  if (language == Language::english) return english;
  for (const Sentence& sentence : kTasks)
    if (const auto holes = holes_of(sentence.english, english))
      return fill(std::string(sentence.french).c_str(), {holes->empty() ? "" : holes->front()});
  for (const Sentence& sentence : kSentences) {
    auto holes = holes_of(sentence.english, english);
    if (!holes) continue;
    for (std::string& hole : *holes) hole = hole_words(language, hole);
    holes->resize(4);
    return fill(std::string(sentence.french).c_str(),
                {holes->at(0), holes->at(1), holes->at(2), holes->at(3)});
  }
  return english;
}

}  // namespace artus
