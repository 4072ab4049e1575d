// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/anatomy/source/patient.h"

#include <algorithm>
#include <cmath>

#include "artus/detail/anatomy/source/bundled_patients.h"
#include "artus/detail/core/known_names.h"
#include "artus/detail/core/noise.h"
#include "artus/detail/core/toml_table.h"

namespace artus {
namespace {

constexpr double kClip = 2;      // SD
constexpr double kGrain = 0.01;  // a drawn value is a multiple of this
constexpr double kAnything = 1e6;

using Pairs = std::vector<std::pair<double, double>>;

/// [[a, b], ...], a ascending, b shares that do not fall when `rises`.
Pairs read_pairs(TomlTable& toml, std::string_view key, bool rises) {
  Pairs pairs;
  const toml::array* list = toml.array(key);
  if (list == nullptr) return pairs;
  bool good = !list->empty();
  for (const toml::node& node : *list) {
    const toml::array* pair = node.as_array();
    const auto at = [&](std::size_t i) {
      return pair != nullptr && pair->size() == 2 ? pair->get(i)->value<double>() : std::nullopt;
    };
    const auto a = at(0);
    const auto b = at(1);
    good = good && a && b && *b >= 0 && *b <= 1;
    if (!good) break;
    if (!pairs.empty()) good = *a > pairs.back().first && (!rises || *b >= pairs.back().second);
    pairs.emplace_back(*a, *b);
  }
  if (rises && good) good = pairs.front().second == 0 && pairs.back().second == 1;
  if (!good)
    toml.problem_at(key, rises ? "must be pairs [value, share] that ascend, shares from 0 to 1"
                               : "must be pairs [age, probability], ages ascending");
  return pairs;
}

void read_normal(TomlTable& toml, std::string_view key, std::size_t sex, Quantity& out) {
  const toml::array* list = toml.array(key);
  const auto at = [&](std::size_t i) {
    return list != nullptr && list->size() == 2 ? list->get(i)->value<double>() : std::nullopt;
  };
  if (at(0) && at(1) && *at(1) > 0) {
    out.mean[sex] = *at(0);
    out.sd[sex] = *at(1);
  } else {
    toml.problem_at(key, "must be [mean, sd], sd above 0");
  }
}

void read_along(TomlTable& toml, const Population& known, Quantity& out) {
  const toml::table* table = toml.table("along");
  if (table == nullptr) return;
  double explained = 0;
  for (const auto& [key, node] : *table) {
    const Quantity* other = known.find(key.str());
    const auto r = node.value<double>();
    if (other == nullptr || !r || std::abs(*r) >= 1) {
      toml.problem_at("along", "must be correlations with quantities above, between -1 and 1");
      return;
    }
    explained += *r * *r;
    out.along.emplace_back(static_cast<std::size_t>(other - known.quantities.data()), *r);
  }
  if (explained >= 1) toml.problem_at("along", "explains more than there is: sum of r^2 >= 1");
}

Quantity read_quantity(const toml::table& table, const Population& known, Problems& problems) {
  TomlTable toml(table, "quantity", problems);
  Quantity out;
  out.name = toml.required_text("name");
  if (!is_plain_name(out.name, '_')) toml.problem_at("name", "may contain only a-z, 0-9 and _");
  if (known.find(out.name) != nullptr) toml.problem_at("name", "is already used");
  out.title = toml.required_text("title");
  out.unit = toml.text("unit").value_or("");
  out.person = toml.boolean("person").value_or(false);
  out.source = toml.required_text("source");
  const bool normal = toml.has("man") || toml.has("woman");
  if (normal) {
    read_normal(toml, "man", 0, out);
    read_normal(toml, "woman", 1, out);
  }
  out.quantiles = read_pairs(toml, "quantiles", true);
  out.chance = read_pairs(toml, "chance", false);
  if (int{normal} + int{toml.has("quantiles")} + int{toml.has("chance")} != 1)
    toml.problem("needs 'man' and 'woman', 'quantiles' or 'chance', one of them");
  read_along(toml, known, out);
  if (toml.has("unless")) out.unless = toml.required_texts("unless");
  for (const std::string& other : out.unless)
    if (known.find(other) == nullptr) toml.problem_at("unless", "'" + other + "' is not above");
  toml.finish();
  return out;
}

KnownPatient read_profile(const toml::table& table, const Population& known, Problems& problems) {
  TomlTable toml(table, "profile", problems);
  KnownPatient out;
  out.name = toml.required_text("name");
  if (!is_plain_name(out.name, '_')) toml.problem_at("name", "may contain only a-z, 0-9 and _");
  out.title = toml.required_text("title");
  out.source = toml.required_text("source");
  if (const toml::table* values = toml.table("values")) {
    TomlTable each(*values, "profile '" + out.name + "'", problems);
    for (const Quantity& q : known.quantities)
      if (const auto value = each.number(q.name, -kAnything, kAnything))
        out.values.push_back({q.name, *value});
    each.finish();
  }
  toml.finish();
  return out;
}

/// Shares below a standard normal score.
double share_below(double z) {
  return std::erfc(-z / std::sqrt(2.0)) / 2;
}

double chance_at(const Pairs& chance, double age) {
  double p = 0;
  for (const auto& [from, probability] : chance)
    if (age >= from) p = probability;
  return p;
}

double quantile(const Pairs& quantiles, double share) {
  std::size_t i = 1;
  while (i + 1 < quantiles.size() && quantiles[i].second < share) ++i;
  const auto& [low, from] = quantiles[i - 1];
  const auto& [high, to] = quantiles[i];
  return to > from ? low + (high - low) * (share - from) / (to - from) : low;
}

std::uint64_t index_of(const std::string& name) {
  std::uint64_t index = 0;
  for (const char c : name) index = mix_bits(index ^ static_cast<unsigned char>(c));
  return index;
}

std::optional<double> value_of(const std::vector<PatientValue>& values, std::string_view name) {
  for (const PatientValue& v : values)
    if (v.name == name) return v.value;
  return std::nullopt;
}

/// A quantity among those of one sex and age.
class Among {
 public:
  Among(const Quantity& quantity, const std::vector<PatientValue>& known)
      : q_(quantity),
        sex_(value_of(known, "sex").value_or(0) >= 0.5 ? 1 : 0),
        age_(value_of(known, "age").value_or(0)),
        excluded_(std::any_of(
            quantity.unless.begin(), quantity.unless.end(),
            [&](const std::string& other) { return value_of(known, other).value_or(0) >= 0.5; })) {}

  [[nodiscard]] double value(double score) const {
    if (q_.sd[sex_] > 0) return q_.mean[sex_] + q_.sd[sex_] * std::clamp(score, -kClip, kClip);
    if (!q_.quantiles.empty()) return quantile(q_.quantiles, share_below(score));
    return !excluded_ && share_below(score) > 1 - chance_at(q_.chance, age_) ? 1 : 0;
  }
  /// The score of a value; of what is not normal the middle one.
  [[nodiscard]] double score(double value) const {
    return q_.sd[sex_] > 0 ? (value - q_.mean[sex_]) / q_.sd[sex_] : 0;
  }

 private:
  const Quantity& q_;
  std::size_t sex_;
  double age_;
  bool excluded_;
};

}  // namespace

const Quantity* Population::find(std::string_view name) const {
  const auto at = std::find_if(quantities.begin(), quantities.end(),
                               [&](const Quantity& q) { return q.name == name; });
  return at == quantities.end() ? nullptr : &*at;
}

Result<Population> parse_population(std::string_view text, const std::string& name) {
  const auto table = parse_toml(text, name);
  ARTUS_TRY(table);
  Problems problems;
  TomlTable toml(*table, "population", problems);
  if (toml.required_number("format", 1, 1) != 1) toml.problem_at("format", "it must be 1");
  Population population;
  for (const toml::table* one : toml.tables("quantity"))
    population.quantities.push_back(read_quantity(*one, population, problems));
  for (const toml::table* one : toml.tables("profile"))
    population.profiles.push_back(read_profile(*one, population, problems));
  toml.finish();
  if (!problems.empty()) return problems.refusal(ErrorCode::invalid, name);
  return population;
}

Result<Population> read_bundled_population() {
  return parse_population(kBundledPatients, "bundled patients");
}

std::vector<PatientValue> draw_patient(const Population& population, std::uint64_t seed,
                                       const std::vector<PatientValue>& given) {
  std::vector<PatientValue> values;
  std::vector<double> scores;
  for (const Quantity& q : population.quantities) {
    const Among among(q, values);
    if (const auto known = value_of(given, q.name)) {
      values.push_back({q.name, *known});
      scores.push_back(among.score(*known));
      continue;
    }
    double score = 0;
    double rest = 1;
    for (const auto& [other, r] : q.along) {
      score += r * scores[other];
      rest -= r * r;
    }
    score += std::sqrt(rest) * normal_noise(seed, index_of(q.name));
    scores.push_back(score);
    values.push_back({q.name, std::round(among.value(score) / kGrain) * kGrain});
  }
  for (const PatientValue& v : given)
    if (population.find(v.name) == nullptr) values.push_back(v);
  return values;
}

}  // namespace artus
