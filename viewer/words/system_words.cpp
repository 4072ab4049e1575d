// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/viewer/words/system_words.h"

#include <array>
#include <optional>
#include <string_view>
#include <vector>

namespace artus {
namespace {

struct Saying {
  std::string_view english;  // {} holds a place
  std::string_view french;
};

// The first row that fits; what stands in a place is looked up again.
constexpr std::array<Saying, 36> kSayings{{
    {"haptics: {}", "haptique : {}"},
    {"imaging: {}", "imagerie : {}"},
    {"SCHED_FIFO priority: {}", "priorité SCHED_FIFO : {}"},
    {"nice value {}: {}", "priorité (nice) {} : {}"},
    {"locking memory: {}", "verrouillage de la mémoire : {}"},
    {"one processor: {}", "un seul processeur : {}"},
    {"imaging failed: {}; it is tried again",
     "l'imagerie a échoué : {} ; elle est tentée de nouveau"},
    {"the tissue stays rigid: {}", "les tissus restent rigides : {}"},
    {"a body without tetrahedra cannot give way", "un corps sans tétraèdres ne peut pas céder"},
    {"no skin below the probe: move it over the body",
     "pas de peau sous la sonde : l'amener sur le corps"},
    {"no bone '{}' holds the tissue around the probe",
     "aucun os « {} » ne tient les tissus autour de la sonde"},
    {"the tissue does not follow the bones so far", "les tissus ne suivent pas les os si loin"},
    {"an image of {} x {} pixels is too large for IMAGE",
     "une image de {} x {} pixels est trop grande pour IMAGE"},
    {"shared memory {} was cut off; {}", "mémoire partagée {} tronquée ; {}"},
    {"shared memory {} cannot be looked at; {}", "mémoire partagée {} illisible ; {}"},
    {"shared memory {} was removed; {}", "mémoire partagée {} supprimée ; {}"},
    {"shared memory {} was replaced; {}", "mémoire partagée {} remplacée ; {}"},
    {"shared memory {} was overwritten; {}", "mémoire partagée {} écrasée ; {}"},
    {"made anew", "recréée"},
    {"there is no such shared memory; start `artus serve`",
     "cette mémoire partagée n'existe pas ; lancer `artus serve`"},
    {"the shared memory belongs to another user",
     "la mémoire partagée appartient à un autre utilisateur"},
    {"a damaged left-over could not be replaced", "un reste endommagé n'a pas pu être remplacé"},
    {"an unknown failure", "une panne inconnue"},
    {"Operation not permitted", "opération non autorisée"},
    {"Permission denied", "permission refusée"},
    {"Cannot allocate memory", "mémoire insuffisante"},
    {"Resource temporarily unavailable", "ressource indisponible pour le moment"},
    {"Invalid argument", "argument non valable"},
    {"No space left on device", "plus de place sur le disque"},
    {"No such file or directory", "fichier introuvable"},
    {"std::bad_alloc", "mémoire insuffisante"},
    {"mouse and keyboard", "souris et clavier"},
    {"simulated hand", "main simulée"},
    {"recorded file", "enregistrement"},
    {"shared memory", "mémoire partagée"},
    {"OpenIGTLink", "OpenIGTLink"},
}};

/// What stands in the pattern's places; empty when the text is another.
std::optional<std::vector<std::string>> match(std::string_view pattern, std::string_view said) {
  std::vector<std::string> places;
  std::size_t hole = pattern.find("{}");
  if (said.substr(0, hole) != pattern.substr(0, hole)) return std::nullopt;
  while (hole != std::string_view::npos) {
    said.remove_prefix(hole);
    pattern.remove_prefix(hole + 2);
    hole = pattern.find("{}");
    const std::string_view behind = pattern.substr(0, hole);
    const bool last = hole == std::string_view::npos;
    const std::size_t at = !last                          ? said.find(behind)
                           : said.size() >= behind.size() ? said.size() - behind.size()
                                                          : std::string_view::npos;
    if (at == std::string_view::npos || said.substr(at, behind.size()) != behind)
      return std::nullopt;
    places.emplace_back(said.substr(0, at));
    said.remove_prefix(at);
    if (last) return places;
  }
  return said == pattern ? std::optional(places) : std::nullopt;
}

}  // namespace

std::string said_by_system(Language language, const std::string& english) {
  if (language == Language::english) return english;
  for (const Saying& saying : kSayings) {
    const auto places = match(saying.english, english);
    if (!places) continue;
    std::string said;
    std::string_view rest = saying.french;
    for (const std::string& place : *places) {
      const std::size_t at = rest.find("{}");
      said += std::string(rest.substr(0, at)) + said_by_system(language, place);
      rest.remove_prefix(at + 2);
    }
    return said + std::string(rest);
  }
  return english;
}

}  // namespace artus
