// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/viewer/words/strings.h"

#include <algorithm>
#include <array>
#include <cstdio>

namespace artus {
namespace {

struct Row {
  const char* english;
  const char* french;
};

// clang-format off
constexpr auto kTexts = static_cast<std::size_t>(Text::n_texts);
constexpr std::array<Row, kTexts> kTable{{
  {"Bring the tip into the {}", "But : amener la pointe de l'aiguille dans cette structure : {}"},
  {"Explore the joint with the probe", "Explorer l'articulation avec la sonde"},
  {"Done: the tip came into the {}", "But atteint : {}"},
  {"Touch this bone with the tip: {}", "But : toucher cet os de la pointe : {}"},
  {"Done: the tip touched the {}", "But atteint, la pointe a touché l'os : {}"},
  {"Next: {}", "Ensuite : {}"},
  {"The device is silent: no force. Put its cable back; the last state is kept", "L'appareil ne répond plus : aucune force. Rebrancher ; le dernier état est gardé"},
  {"Next: {} takes the probe to explore, {} the needle at the planned entry", "Ensuite : {} pour prendre la sonde et explorer, {} pour l'aiguille au point d'entrée prévu"},
  {"Next: move the mouse until the picture shows the {}; then {} chooses the entry, or {} lets go", "Ensuite : déplacer la souris jusqu'à voir cette structure : {} ; puis {} choisit l'entrée, {} lâche"},
  {"The probe is off the skin: press it on with {}, or {} puts it back", "La sonde ne touche pas la peau : {} pour l'appuyer, {} pour la remettre au départ"},
  {"Next: {} takes the needle, which stands at the entry", "Ensuite : {} pour prendre l'aiguille, déjà au point d'entrée"},
  {"Next: wheel or {} pushes the needle in; {} pulls", "Ensuite : molette ou {} pour enfoncer l'aiguille, {} pour la retirer"},
  {"The needle is not in the picture's plane: turn it with the mouse until it is", "L'aiguille est hors du plan de l'image : l'orienter avec la souris"},
  {"The needle is {} mm beside the picture: {} takes the probe, slide it over the needle", "L'aiguille passe à {} mm de l'image : {} pour prendre la sonde et la glisser sur l'aiguille"},
  {"Next: go on, the tip in sight: {} mm to go", "Ensuite : avancer en gardant la pointe en vue, encore {} mm"},
  {"Bone: pull back with {} and aim beside it", "Os : reculer avec {} et viser à côté"},
  {"The hub is on the skin: this needle is {} mm long. Pull back with {}", "L'embase touche la peau : l'aiguille mesure {} mm. Reculer avec {}"},
  {"Next: {} freezes, {} saves the picture; then {} pulls the needle out", "Ensuite : {} pour figer, {} pour enregistrer l'image, puis {} pour retirer l'aiguille"},
  {"Next: two clicks measure, {} saves the picture; {} goes on", "Ensuite : deux clics pour mesurer, {} pour enregistrer l'image, {} pour reprendre"},
  {"Next: {} pulls the needle out", "Ensuite : {} pour retirer l'aiguille"},
  {"Done. {} begins again", "Terminé. {} pour recommencer"},
  {"A simulated or other hand is at work: watch", "Une main simulée ou un autre appareil opère : observer"},
  {"Paused: {} goes on", "En pause : {} pour reprendre"},
  {"What would you like to do?", "Que voulez-vous faire ?"},
  {"Explore with the probe", "Explorer avec la sonde"},
  {"Inject {}: {}", "Injection {} : {}"},
  {"Train: tasks with a verdict, a review and a record", "S'entraîner : exercices avec verdict, revue et dossier"},
  {"Help: all keys", "Aide : toutes les touches"},

  {"no device yet: artus view --input hand needs none", "aucun appareil : artus view --input hand n'en demande pas"},
  {"no device yet: start a program that writes {} (docs/protocol.md), or: artus view --input hand", "aucun appareil : lancer un programme qui écrit {} (docs/protocol.md), ou : artus view --input hand"},
  {"no tracker yet: let it send transforms to this machine by OpenIGTLink (docs/openigtlink.md)", "aucun système de localisation : lui faire envoyer ses transformations à cette machine par OpenIGTLink (docs/openigtlink.md)"},

  {"Task", "Tâche"}, {"B-mode", "Mode B"}, {"Joint", "Articulation"}, {"Scanner", "Échographe"},
  {"Session", "Séance"}, {"Tissues", "Tissus"}, {"Force", "Force"}, {"Rates", "Cadences"}, {"Keys", "Touches"},

  {"depth", "profondeur"}, {"gain", "gain"}, {"TGC slope", "pente TGC"}, {"range", "dynamique"},
  {"frequency", "fréquence"}, {"focus", "focale"}, {"preset", "préréglage"},
  {"shoulder", "épaule"}, {"deep (hip)", "profond (hanche)"}, {"shallow (hand)", "superficiel (main)"},
  {"zoom", "zoom"}, {"flip left-right", "inverser gauche-droite"}, {"dual", "double"}, {"colour", "couleur"},
  {"freeze", "figer"}, {"go on", "reprendre"}, {"save", "enregistrer"}, {"clip", "vidéo"}, {"end clip", "arrêter"},
  {"true scale", "échelle réelle"}, {"no calipers", "sans mesures"}, {"usual settings", "réglages usuels"},
  {"cine", "ciné"}, {"no image yet", "pas encore d'image"}, {"frozen", "figé"}, {"kept", "gardée"}, {"SIMULATED", "SIMULÉ"},
  {"pseudonym", "pseudonyme"}, {"left", "gauche"}, {"right", "droite"}, {"TGC, dB from shallow to deep", "TGC, dB, du superficiel au profond"},

  {"tip in: {}", "pointe dans : {}"}, {"tip to target {} mm", "pointe à {} mm de la cible"},
  {"needle in plane", "aiguille dans le plan"}, {"needle out of plane: {} mm, {} deg", "aiguille hors du plan : {} mm, {}°"},
  {"needle {} G, {} mm", "aiguille {} G, {} mm"}, {"the hand is {} mm further: {} N", "la main est {} mm plus loin : {} N"},
  {"hub on the skin", "embase sur la peau"}, {"depth {} mm   {} N   {} mN m", "profondeur {} mm   {} N   {} mN m"},
  {"probe {} N, {} % of its face", "sonde {} N, {} % de sa face"},
  {"turn within {} deg", "tourner de {}° au plus"}, {"images {} Hz, window {} Hz", "images {} Hz, fenêtre {} Hz"}, {"last state, {} s ago; now: {}", "dernier état, il y a {} s ; à présent : {}"},
  {"pause", "pause"}, {"reset", "recommencer"}, {"expert", "expert"}, {"aids", "aides"}, {"names", "noms"}, {"left-handed", "gaucher"},
  {"exploring", "exploration"}, {"inserting", "insertion"}, {"cut away at the image plane", "coupe au plan de l'image"},
  {"refused: {}", "refusé : {}"}, {"{}: {}", "{} : {}"}, 
  {"absent", "absent"}, {"alive", "en marche"}, {"lost", "perdu"}, {"invalid", "invalide"},

  {"against insertion, N, over 10 s", "contre l'insertion, N, sur 10 s"}, {"insertion, {} mm", "insertion, {} mm"},
  {"along", "axiale"}, {"sideways", "latérale"}, {"probe", "sonde"},
  {"haptics: compute, lateness; 1 us .. 1 s", "haptique : calcul, retard ; 1 µs .. 1 s"}, {"images: render, interval; 1 us .. 1 s", "images : calcul, intervalle ; 1 µs .. 1 s"},
  {"haptics {} Hz, compute p99.9 {} us   late p99 {} us", "haptique {} Hz, calcul p99,9 {} µs   retard p99 {} µs"},
  {"images {} Hz, pose to image p95 {} ms   window {} Hz", "images {} Hz, pose à image p95 {} ms   fenêtre {} Hz"},

  {"saved {}", "enregistré : {}"}, {"cannot write {}", "impossible d'écrire {}"}, {"clip begun: {}", "vidéo commencée : {}"},
  {"saved clip of {} pictures: {}", "vidéo de {} images enregistrée : {}"}, {"REC", "REC"},
  {"The needle is in: pull it out before another entry is chosen", "L'aiguille est dans le corps : la retirer avant de choisir une autre entrée"},
  {"No skin beside the probe here: bring the probe back onto the body", "Pas de peau à côté de la sonde : ramener la sonde sur le corps"},
  {"An entry is chosen already: {} goes back to exploring", "Une entrée est déjà choisie : {} revient à l'exploration"},
  {"The needle is in: pull it out before going back to exploring", "L'aiguille est dans le corps : la retirer avant de revenir à l'exploration"},
  {"The entry point is at the needle; {} takes it", "Le point d'entrée est à l'aiguille ; {} la prend"}, {"Back to exploring", "Retour à l'exploration"},
  {"The probe lifts off the skin", "La sonde quitte la peau"}, {"The probe lies on the skin", "La sonde repose sur la peau"},
  {"The needle is back where it was", "L'aiguille est revenue où elle était"}, {"No withdrawal to undo", "Aucun retrait à annuler"},
  {"This key moves a hand; the session is driven by: {}", "Cette touche déplace une main, or la séance est menée par : {}"},
  {"needle in hand: wheel or {} {} push and pull, mouse turns, {} lets go", "aiguille en main : la molette ou {} {} l'enfonce et la retire, la souris l'oriente, {} la lâche"},
  {"probe in hand: mouse slides, ctrl tilts, wheel turns, {} {} press and lift, {} lets go", "sonde en main : la souris la fait glisser (ctrl : l'incline), la molette la tourne, {} {} l'appuie et la soulève, {} la lâche"},
  {"thumb on the plunger: wheel or {} {} press and draw back, {} lets go", "pouce sur le piston : la molette ou {} {} appuie et aspire, {} le lâche"},
  {"syringe: {} ml left, {} given, {} ml/s", "seringue : reste {} ml, {} injecté, {} ml/s"}, {"thumb {} N, {} kPa at the tip", "pouce {} N, {} kPa à la pointe"},
  {"Ow! It shoots down my arm.", "Aïe ! Ça me lance dans le bras."}, {"Something gave way.", "Quelque chose a lâché."}, {"My heart is racing.", "Mon cœur s'emballe."},
  {"That hurts.", "Ça fait mal."}, {"That is too fast, it burns.", "C'est trop rapide, ça brûle."}, {"I feel pressure.", "Je sens que ça appuie."},
  {"Caliper: arrows move the cross, {} sets a point", "Mesure : les flèches déplacent la croix, {} pose un point"},
  {"Colour Doppler of the needle: drag the box, or move it with the arrows. Blood is not simulated", "Doppler couleur de l'aiguille : glisser le cadre, ou le déplacer avec les flèches. Le sang n'est pas simulé"},
  {"The panels are back in their places", "Les panneaux sont remis en place"},

  {"all well", "tout va bien"}, {"device lost: no force", "appareil perdu : aucune force"}, {"device sends no valid pose", "pose invalide de l'appareil"},
  {"paused", "en pause"}, {"no needle", "pas d'aiguille"}, {"pose not finite", "pose non finie"}, {"pose not rigid", "pose non rigide"},
  {"needle jumped", "saut de l'aiguille"}, {"time ran backwards", "le temps a reculé"}, {"pose is stale", "pose périmée"},
  {"out of the workspace", "hors de l'espace de travail"}, {"force not finite", "force non finie"}, {"force ramps up", "la force monte"},
  {"change limited", "variation limitée"}, {"at the device's limit", "à la limite de l'appareil"}, {"on bone", "sur l'os"},

  {"take the probe: mouse slides it on the skin, wheel turns it", "prendre la sonde : la souris la fait glisser sur la peau, la molette la tourne"},
  {"choose the entry beside the probe: the joint comes to the needle", "choisir le point d'entrée à côté de la sonde : l'articulation vient à l'aiguille"},
  {"back to exploring", "revenir à l'exploration"}, {"take the needle: mouse turns it about the entry, wheel pushes", "prendre l'aiguille : la souris l'oriente autour du point d'entrée, la molette l'enfonce"},
  {"push and pull the needle; press and lift the probe in hand", "enfoncer et retirer l'aiguille ; appuyer et soulever la sonde en main"},
  {"put the thumb on the plunger, or off: the wheel presses and draws back", "mettre le pouce sur le piston, ou l'enlever : la molette appuie et aspire"},
  {"with mouse, wheel or arrows: a tenth as far", "avec souris, molette ou flèches : dix fois moins loin"},
  {"ctrl with the probe in hand: mouse rocks and fans, wheel presses", "ctrl, sonde en main : la souris l'incline, la molette l'appuie"},
  {"let go; close this help", "lâcher ; fermer cette aide"}, {"needle and probe back to the start", "aiguille et sonde au départ"}, {"undo the last withdrawal", "annuler le dernier retrait"},
  {"freeze the picture", "figer l'image"}, {"save the picture as PNG", "enregistrer l'image en PNG"}, {"begin and end a clip", "commencer et finir une vidéo"},
  {"picture at true scale", "image à l'échelle réelle"}, {"caliper by keys, a point; two clicks in the picture measure, too", "mesure au clavier, un point ; deux clics dans l'image mesurent aussi"},
  {"remove the calipers", "effacer les mesures"}, {"deeper, shallower", "plus profond, moins profond"}, {"more gain, less gain", "plus de gain, moins de gain"},
  {"zoom in, zoom out; a drag or the arrows move what is seen", "agrandir, réduire ; glisser ou flèches déplacent la partie vue"}, {"left-right flip", "inverser gauche-droite"}, {"keep this picture beside the live one", "garder cette image à côté de l'image en direct"},
  {"colour Doppler: what moves, red toward the probe", "Doppler couleur : ce qui bouge, rouge vers la sonde"},
  {"frozen: step back and forth through the last 20 s", "image figée : reculer et avancer dans les 20 dernières secondes"}, {"turn the probe in hand", "tourner la sonde en main"},
  {"move what is in hand; nothing in hand: turn the joint", "déplacer ce qui est en main ; rien en main : tourner l'articulation"}, {"next panel", "panneau suivant"},
  {"names of the structures on the picture", "noms des structures sur l'image"}, {"aids on and off", "afficher ou masquer les aides"}, {"pause", "pause"},
  {"forget the insertion", "oublier l'insertion"}, {"expert mode: no 3D view, no aids", "mode expert : ni vue 3D ni aides"}, {"panels back in their places", "panneaux remis en place"}, {"a task is done", "fin de l'exercice"}, {"this help", "cette aide"},
  {"left stick probe, right stick needle, triggers push and pull; right bumper: the triggers press the plunger; A entry, B back, X freeze, Y reset", "manche gauche : sonde, droit : aiguille, gâchettes : enfoncer et retirer ; bouton RB : les gâchettes appuient sur le piston ; A entrée, B retour, X figer, Y recommencer"},
  {"drag turns the joint, wheel comes nearer", "glisser fait tourner l'articulation, la molette rapproche"},
  {"gamepad: {}", "manette : {}"},
  {"Task", "Exercice"}, {"Patient", "Patient"}, {"I am done", "J'ai fini"},
  {"Not in this task: it is judged without aids", "Pas dans cet exercice, jugé sans aide"},
  {"judged afterwards", "jugé à la fin"}, {"Task: {}", "Exercice : {}"},
  {"{} and {} choose, {} goes on", "{} et {} pour choisir, {} pour continuer"}, {"{} and {} choose, {} goes on, {} goes back", "{} et {} pour choisir, {} pour continuer, {} pour revenir"},
  {"You, at {} s", "Vous, à {} s"}, {"The expert, at {} s", "L'expert, à {} s"},
  {"The probe set right: turned {} degrees, moved {} mm", "Sonde bien placée : tournée de {} degrés, déplacée de {} mm"},
  {"Inside the joint", "Dans l'articulation"}, {"truth", "vérité"}, {"play", "lire"}, {"Back", "Retour"},
  {"earlier fault", "faute précédente"}, {"later fault", "faute suivante"}, {"other picture", "autre image"},
  {"depth, mm", "profondeur, mm"}, {"force, N", "force, N"}, {"thumb, N", "pouce, N"},
  {"No fault stood out", "Aucune faute ne ressort"}, {"Why: {}", "Cause : {}"}, {"Do: {}", "À faire : {}"},
  {"The needle is not in the body here", "L'aiguille n'est pas dans le corps à cet instant"},
  {"stop", "arrêter"},
  {"Esc", "Échap"}, {"Space", "Espace"}, {"Home", "Début"}, {"Tab", "Tab"}, {"Enter", "Entrée"}, {"Backspace", "Retour arrière"},
  {"Left", "Gauche"}, {"Right", "Droite"}, {"Up", "Haut"}, {"Down", "Bas"}, {"Page up", "Page préc."}, {"Page down", "Page suiv."},
  {"shift", "maj"}, {"ctrl", "ctrl"},
}};
// clang-format on

}  // namespace

std::optional<Language> find_language(std::string_view name) noexcept {
  if (name.substr(0, 2) == "fr") return Language::french;
  if (name.substr(0, 2) == "en") return Language::english;
  return std::nullopt;
}

const char* text(Language language, Text which) noexcept {
  const Row& row = kTable[static_cast<std::size_t>(which)];
  return language == Language::french ? row.french : row.english;
}

std::string fill(std::string_view pattern, std::initializer_list<std::string_view> values) {
  std::string out;
  for (const std::string_view value : values) {
    const std::size_t at = pattern.find("{}");
    if (at == std::string_view::npos) break;
    out += pattern.substr(0, at);
    out += value;
    pattern.remove_prefix(at + 2);
  }
  out += pattern;
  return out;
}

std::string number(Language language, double value, int decimals) {
  std::array<char, 48> digits{};
  std::snprintf(digits.data(), digits.size(), "%.*f", decimals, value);
  std::string shown(digits.data());
  if (shown.find_first_not_of("-0.") == std::string::npos && shown[0] == '-') shown.erase(0, 1);
  if (language == Language::french) std::replace(shown.begin(), shown.end(), '.', ',');
  return shown;
}

}  // namespace artus
