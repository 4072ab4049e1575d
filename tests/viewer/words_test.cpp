// SPDX-License-Identifier: AGPL-3.0-or-later
#include <array>
#include <filesystem>
#include <fstream>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "artus/detail/viewer/words/anatomy_names.h"
#include "artus/detail/viewer/words/retell.h"
#include "artus/detail/viewer/words/system_words.h"
#include "artus/detail/viewer/words/translation.h"
#include "tests/support/paths.h"

namespace artus {
namespace {

// That every sentence of the sources has a French text with the same places: scripts/update-po
// --check.
TEST(Translation, ASentenceIsFoundInTheCatalogueOrStaysAsItIs) {
  EXPECT_STREQ(translate(Language::english, "freeze the picture"), "freeze the picture");
  EXPECT_STREQ(translate(Language::french, "freeze the picture"), "figer l'image");
  const char* unknown = "a sentence that nobody says";
  EXPECT_EQ(translate(Language::french, unknown), unknown);
  EXPECT_STREQ(translate(Language::french, ""), "") << "the catalogue's own head is no text";
}

TEST(Translation, AContextTellsWhichMeaningIsMeant) {
  EXPECT_STREQ(translate_in(Language::french, "anatomy", "humerus"), "humérus");
  EXPECT_STREQ(translate_in(Language::french, "cooking", "humerus"), "humerus");
  EXPECT_STREQ(translate(Language::french, "humerus"), "humerus");
}

TEST(Translation, CountsFollowThePluralRuleOfTheLanguage) {
  const auto clip = [](Language language, long n) {
    return translate_count(language, "saved clip of {} picture: {}",
                           "saved clip of {} pictures: {}", n);
  };
  EXPECT_STREQ(clip(Language::english, 0), "saved clip of {} pictures: {}");
  EXPECT_STREQ(clip(Language::english, 1), "saved clip of {} picture: {}");
  EXPECT_STREQ(clip(Language::french, 0), "vidéo de {} image enregistrée : {}");
  EXPECT_STREQ(clip(Language::french, 2), "vidéo de {} images enregistrée : {}");
  EXPECT_STREQ(translate_count(Language::french, "one thing", "many things", 2), "many things");
}

TEST(Retell, TheFirstPatternThatFitsIsTranslatedAndSoAreItsPlaces) {
  constexpr std::array kPatterns{"the tip was in {}", "{}: {}", "no image yet"};
  const auto french = [&](const std::string& english) {
    return retell(Language::french, kPatterns, english);
  };
  EXPECT_EQ(french("the tip was in biceps_sheath"), "la pointe était dans : gaine du biceps");
  EXPECT_EQ(french("1.50: no image yet"), "1,50 : pas encore d'image");
  EXPECT_EQ(french("/dev/x_y: unknown"), "/dev/x_y : unknown") << "names stay";
  EXPECT_EQ(french("something else"), "something else");
  EXPECT_EQ(retell(Language::english, kPatterns, "1.50: no image yet"), "1.50: no image yet");
}

TEST(Translation, PlacesAreFilledInOrderAndNumbersAreTheLanguages) {
  EXPECT_EQ(fill("{} of {}", {"two", "three"}), "two of three");
  EXPECT_EQ(fill("none", {"two"}), "none");
  EXPECT_EQ(number(Language::french, 2.54, 1), "2,5");
  EXPECT_EQ(number(Language::english, -0.04, 1), "0.0");
  EXPECT_EQ(find_language("fr_FR.UTF-8"), Language::french);
  EXPECT_FALSE(find_language("de"));
}

std::string content_of(const std::filesystem::path& file) {
  std::ifstream in(file);
  std::stringstream all;
  all << in.rdbuf();
  return all.str();
}

TEST(Translation, NoPanelSaysWordsThatAreNotTranslated) {
  // What a function that shows text is given first; names behind ## are of no language.
  const std::regex shown(
      "(Button|SmallButton|Checkbox|TextUnformatted|TextWrapped|Text|SliderInt|outlined_text|"
      "wrapped|coloured|say|SetTooltip|Selectable|MenuItem|fill)\\(\\s*\"([^\"]*)\"");
  const std::set<std::string> no_words{"-", "+", "?", "%s"};
  std::size_t files = 0;
  for (const auto& entry :
       std::filesystem::recursive_directory_iterator(test::source_dir() / "viewer")) {
    if (entry.path().extension() != ".cpp") continue;
    ++files;
    const std::string code = content_of(entry.path());
    for (std::sregex_iterator i(code.begin(), code.end(), shown), end; i != end; ++i) {
      const std::string said = (*i)[2];
      const bool name = said.rfind("##", 0) == 0 || (*i)[1] == "InvisibleButton" ||
                        said == "picture" || said == "joint";
      EXPECT_TRUE(name || no_words.count(said) == 1) << entry.path() << ": " << i->str();
    }
  }
  EXPECT_GT(files, 20U);
}

TEST(SystemWords, WhatTheSystemSaysIsSaidInFrench) {
  const auto french = [](const std::string& english) {
    return said_by_system(Language::french, english);
  };
  EXPECT_EQ(french("haptics: SCHED_FIFO priority: Operation not permitted"),
            "haptique : priorité SCHED_FIFO : opération non autorisée");
  EXPECT_EQ(french("imaging: nice value -10: Permission denied"),
            "imagerie : priorité (nice) -10 : permission refusée");
  EXPECT_EQ(french("shared memory /artusPOS was removed; recreated"),
            "mémoire partagée /artusPOS supprimée ; recréée");
  EXPECT_EQ(french("an image of 700 x 900 pixels is too large for IMAGE"),
            "une image de 700 x 900 pixels est trop grande pour IMAGE");
  EXPECT_EQ(french("imaging failed: std::bad_alloc; trying again"),
            "l'imagerie a échoué : mémoire insuffisante ; elle est tentée de nouveau");
  EXPECT_EQ(french("what nobody knows"), "what nobody knows");
  EXPECT_EQ(said_by_system(Language::english, "mouse and keyboard"), "mouse and keyboard");
}

/// What a file's code says by one of these calls, or names with them.
std::vector<std::string> said_in(const char* file, const std::string& call) {
  const std::string code = content_of(test::source_dir() / "session" / file);
  const std::regex said(call + "\"([^\"]+)\"");
  std::vector<std::string> all;
  for (std::sregex_iterator i(code.begin(), code.end(), said), end; i != end; ++i)
    all.push_back((*i)[1]);
  return all;
}

TEST(SystemWords, EverythingThatTheSessionTellsIsInTheTable) {
  const std::string table = content_of(test::source_dir() / "viewer/words/system_words.cpp");
  std::size_t n = 0;
  for (const auto& [file, call] :
       {std::pair{"session.cpp", "tell\\("},
        {"session.cpp", "request_priority\\("},
        {"session_thread.cpp", "refused\\.push_back\\("},
        {"shm/shared_memory.cpp", "return "},
        {"hand_device.h", "name\\(\\) const noexcept override \\{ return "},
        {"injecting_device.h", "name\\(\\) const noexcept override \\{ return "},
        {"record/recorded_device.h", "name\\(\\) const noexcept override \\{ return "},
        {"shm/shared_memory_device.h", "name\\(\\) const noexcept override \\{ return "}}) {
    const auto all = said_in(file, call);
    EXPECT_FALSE(all.empty()) << file << ' ' << call;
    n += all.size();
    for (const std::string& said : all) {
      EXPECT_NE(table.find(said), std::string::npos) << file << ": " << said;
    }
  }
  EXPECT_GE(n, 15U);
}

/// The names of the tables of these kinds in a file.
std::vector<std::string> names_in(const std::filesystem::path& joint,
                                  const std::set<std::string>& kinds) {
  std::vector<std::string> names;
  std::ifstream in(joint);
  bool wanted = false;
  for (std::string line; std::getline(in, line);) {
    if (line.rfind("[[", 0) == 0) wanted = kinds.count(line) != 0;
    if (!wanted || line.rfind("name = \"", 0) != 0) continue;
    names.push_back(line.substr(8, line.rfind('"') - 8));
    wanted = false;
  }
  return names;
}

TEST(AnatomyNames, EveryBoneThatCanBeFeltHasAFrenchName) {
  for (const char* person : {"sitting.toml", "lying.toml"}) {
    const auto names =
        names_in(test::source_dir() / "meshes" / "person" / person, {"[[landmark]]"});
    EXPECT_GT(names.size(), 12U) << person;
    for (const std::string& name : names)
      EXPECT_TRUE(known_name(Language::french, name) || name == "acromion" || name == "patella")
          << name;
  }
}

TEST(AnatomyNames, EveryStructureAndInjectionOfOurJointsHasAFrenchName) {
  const std::set<std::string> alike{"fibula",    "tibia",     "patella", "scapula",
                                    "sartorius", "cartilage", "tendon",  "muscle",
                                    "radius",    "ulna",      "talus"};
  for (const char* joint :
       {"simple-shoulder", "shoulder", "real-shoulder", "elbow", "wrist", "hip", "knee", "ankle"}) {
    const auto names = names_in(test::source_dir() / "meshes" / joint / "joint.toml",
                                {"[[structure]]", "[[injection]]"});
    EXPECT_GT(names.size(), 5U) << joint;
    for (const std::string& name : names) {
      if (alike.count(name) == 0) {
        EXPECT_NE(clinical_name(Language::french, name), clinical_name(Language::english, name))
            << joint;
      }
    }
  }
}

}  // namespace
}  // namespace artus
