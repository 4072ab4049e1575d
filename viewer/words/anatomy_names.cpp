// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/viewer/words/anatomy_names.h"

#include <algorithm>
#include <string_view>

namespace artus {
namespace {

/// As English people say it.
std::string plain_name(const std::string& name) {
  if (name == "outside") return "outside the body";
  if (name == "beyond") return "beyond the model";
  if (name == "injected") return "injected liquid";
  std::string plain = name;
  std::replace(plain.begin(), plain.end(), '_', ' ');
  return plain;
}

bool is_filling(const CompiledJoint& joint, RegionId region) {
  return region == kFirstRegion && joint.tissue_of(region).acoustic.kind == TissueKind::fat;
}

/// The tissue's name of the stretch beside the k-th; empty where there is none.
std::string_view tissue_beside(const CompiledJoint& joint, std::span<const TissueInterval> line,
                               std::size_t k, bool before) {
  if (before ? k == 0 : k + 1 >= line.size()) return {};
  const RegionId region = line[before ? k - 1 : k + 1].region;
  return region < kFirstRegion ? std::string_view()
                               : std::string_view(joint.tissue_of(region).name);
}

}  // namespace

std::string clinical_name(Language language, const std::string& name) {
  const std::string plain = plain_name(name);
  return translate_in(language, "anatomy", plain.c_str());
}

std::optional<std::string> known_name(Language language, const std::string& name) {
  const std::string plain = plain_name(name);
  const char* known = translate_in(language, "anatomy", plain.c_str());
  return known == plain.c_str() ? std::nullopt : std::optional<std::string>(known);
}

std::string layer_name(Language language, const CompiledJoint& joint,
                       std::span<const TissueInterval> line, std::size_t k) {
  const RegionId region = line[k].region;
  if (!is_filling(joint, region)) return clinical_name(language, joint.regions[region].name);
  const std::string_view before = tissue_beside(joint, line, k, true);
  const std::string_view after = tissue_beside(joint, line, k, false);
  if (before == "bursa" || after == "bursa") return translate(language, "fat around the bursa");
  if (before == "skin" || after == "skin" || before.empty())  // on the way in or out
    return translate(language, "fat under the skin");
  return translate(language, "fat between the muscles");
}

}  // namespace artus
