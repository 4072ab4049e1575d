// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/anatomy/source/joint_parameter.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "artus/detail/anatomy/source/joint_parameter_toml.h"
#include "artus/detail/anatomy/source/patient.h"
#include "artus/detail/core/known_names.h"
#include "artus/detail/core/printed.h"

namespace artus {
namespace {

constexpr double kFarthestValue = 1e6;
constexpr double kYes = 0.5;  // a value from here on switches a variant on

/// One number of the joint file that a parameter moves.
struct ParameterAction {
  std::string key;             ///< "structure.deltoid.grow"
  double per = 0;              ///< of the key's unit for each unit of the parameter
  std::optional<double> base;  ///< at the modelled value; else what the file says
};

struct ParameterEntry {
  JointParameter parameter;
  std::vector<ParameterAction> actions;
  std::string variant;
};

ParameterEntry read_parameter(const std::string& name, const toml::table& table,
                              Problems& problems) {
  TomlTable toml(table, "parameter '" + name + "'", problems);
  ParameterEntry out;
  JointParameter& p = out.parameter;
  p.name = name;
  p.title = toml.required_text("title");
  p.unit = toml.text("unit").value_or("");
  p.modelled = toml.required_number("modelled", -kFarthestValue, kFarthestValue);
  p.least = toml.required_number("least", -kFarthestValue, kFarthestValue);
  p.most = toml.required_number("most", -kFarthestValue, kFarthestValue);
  if (p.least > p.modelled || p.modelled > p.most)
    toml.problem("'modelled' must lie between 'least' and 'most'");
  p.usual = toml.number("usual", -kFarthestValue, kFarthestValue);
  if (p.usual && (*p.usual < p.least || p.most < *p.usual))
    toml.problem("'usual' must lie between 'least' and 'most'");
  out.variant = toml.text("variant").value_or("");
  if (p.usual && out.variant.empty()) toml.problem("'usual' is a variant's: it needs 'variant'");
  for (const toml::table* one : toml.tables("acts")) {
    TomlTable act(*one, "parameter '" + name + "': acts", problems);
    ParameterAction action;
    action.key = act.required_text("key");
    action.per = act.required_number("per", -kFarthestValue, kFarthestValue);
    action.base = act.number("base", -kFarthestValue, kFarthestValue);
    act.finish();
    out.actions.push_back(std::move(action));
  }
  if (out.actions.empty() && out.variant.empty())
    toml.problem("does nothing: it needs 'acts' or 'variant'");
  toml.finish();
  return out;
}

std::vector<ParameterEntry> read_entries_of(const toml::table& joint, Problems& problems) {
  std::vector<ParameterEntry> entries;
  const toml::node* node = joint.get("parameter");
  if (node == nullptr) return entries;
  const toml::table* all = node->as_table();
  if (all == nullptr) {
    problems.add(*node, "joint: 'parameter' must be tables: [parameter.NAME]");
    return entries;
  }
  for (const auto& [key, value] : *all) {
    const std::string name(key.str());
    if (value.is_table() && is_plain_name(name, '_'))
      entries.push_back(read_parameter(name, *value.as_table(), problems));
    else
      problems.add(value, "parameter '" + name +
                              "' must be a table [parameter.NAME], NAME of a-z, " + "0-9 and _");
  }
  return entries;
}

/// The tables that all but the last part of a key names; tissues' own are made where there are
/// none.
std::vector<toml::table*> find_tables(toml::table& joint, std::string_view path) {
  std::vector<toml::table*> found{&joint};
  const bool may_make = path.rfind("tissue.", 0) == 0;
  const toml::array* list = nullptr;
  while (!path.empty()) {
    const std::size_t dot = std::min(path.find('.'), path.size());
    const std::string part(path.substr(0, dot));
    path.remove_prefix(std::min(dot + 1, path.size()));
    std::vector<toml::table*> next;
    if (list != nullptr) {
      for (const toml::node& item : *list)
        if (const toml::table* table = item.as_table(); table != nullptr)
          if ((*table)["name"].value<std::string>() == part)
            next.push_back(const_cast<toml::table*>(table));  // NOLINT: of `joint`, which is ours
      list = nullptr;
      found = std::move(next);
      continue;
    }
    for (toml::table* table : found) {
      if (may_make && !table->contains(part)) table->insert(part, toml::table{});
      if (toml::table* inner = table->get_as<toml::table>(part)) next.push_back(inner);
      list = table->get_as<toml::array>(part);
    }
    if (list == nullptr) found = std::move(next);
  }
  return list == nullptr ? found : std::vector<toml::table*>{};
}

/// Those of the joint, and of variants that bring their own in the place of the joint's.
std::vector<toml::table*> find_with_variants(toml::table& joint, std::string_view path) {
  std::vector<toml::table*> found = find_tables(joint, path);
  toml::table* variants = joint.get_as<toml::table>("variant");
  if (variants == nullptr) return found;
  for (auto&& [name, variant] : *variants)
    if (toml::table* own = variant.as_table(); own && own->contains(path.substr(0, path.find('.'))))
      for (toml::table* table : find_tables(*own, path)) found.push_back(table);
  return found;
}

void apply_action(toml::table& joint, const ParameterAction& action, double away,
                  const std::string& name, Problems& problems) {
  const std::size_t dot = action.key.rfind('.');
  const std::string last = action.key.substr(dot == std::string::npos ? 0 : dot + 1);
  const auto tables = dot == std::string::npos
                          ? std::vector<toml::table*>{}
                          : find_with_variants(joint, std::string_view(action.key).substr(0, dot));
  if (tables.empty()) {
    problems.add(joint, "parameter '" + name + "': there is nothing named " + action.key);
    return;
  }
  for (toml::table* table : tables) {
    auto base = (*table)[last].value<double>();
    if (!base) base = last == "grow" ? 0.0 : action.base;
    if (base)
      table->insert_or_assign(last, *base + action.per * away);
    else
      problems.add(*table, "parameter '" + name + "': the file has no " + action.key +
                               "; say what it is as modelled (base = ...)");
  }
}

Result<double> read_value(const std::string& term, const std::string& text) {
  double value = 0;
  const char* end = text.data() + text.size();
  const auto read = std::from_chars(text.data(), end, value);
  if (read.ec != std::errc{} || read.ptr != end || !std::isfinite(value))
    return fail(ErrorCode::malformed, "patient: '" + term + "' is not NAME=NUMBER");
  return value;
}

void set_value(std::vector<PatientValue>& values, const std::string& name, double value) {
  const auto at = std::find_if(values.begin(), values.end(),
                               [&](const PatientValue& v) { return v.name == name; });
  if (at == values.end())
    values.push_back({name, value});
  else
    at->value = value;
}

const JointParameter* find_parameter(const std::vector<JointParameter>& parameters,
                                     const std::string& name) {
  for (const JointParameter& p : parameters)
    if (p.name == name) return &p;
  return nullptr;
}

/// Whether the joint can have this value, said by hand.
Result<void> check_value(const std::string& name, double value, const Population& population,
                         const std::vector<JointParameter>& parameters) {
  const Quantity* quantity = population.find(name);
  if (const JointParameter* p = find_parameter(parameters, name)) {
    if (value >= p->least && value <= p->most) return {};
    return fail(
        ErrorCode::invalid,
        "patient: " + name + printed("=%.6g", value) +
            printed(" is outside of what the joint can take, %.6g to %.6g ", p->least, p->most) +
            p->unit);
  }
  if (quantity != nullptr && quantity->person) return {};
  std::vector<std::string_view> known = item_names(parameters);
  for (const Quantity& q : population.quantities)
    if (q.person && find_parameter(parameters, q.name) == nullptr) known.emplace_back(q.name);
  return fail(ErrorCode::not_found, "patient: the joint has no parameter '" + name + "'" +
                                        did_you_mean(name, known) + "; it has " + listed(known));
}

/// What the terms of a text say, not yet fitted to a joint.
struct PatientTerms {
  std::vector<PatientValue> known;  ///< of profiles
  std::vector<PatientValue> said;   ///< by hand
  std::optional<std::uint64_t> seed;
};

Result<PatientTerms> read_terms(const std::string& text, const Population& population) {
  PatientTerms terms;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    const std::string term = text.substr(begin, end - begin);
    begin = end + 1;
    const std::size_t equals = term.find('=');
    if (equals == std::string::npos) {
      const auto profile = find_name(item_names(population.profiles), term, "patient");
      ARTUS_TRY(profile);
      for (const PatientValue& v : population.profiles[*profile].values)
        set_value(terms.known, v.name, v.value);
      continue;
    }
    const std::string name = term.substr(0, equals);
    const auto value = read_value(term, term.substr(equals + 1));
    ARTUS_TRY(value);
    if (name != "seed") {
      set_value(terms.said, name, *value);
      continue;
    }
    if (!(*value >= 0 && *value <= 1e15) || *value != std::floor(*value))
      return fail(ErrorCode::malformed, "patient: a seed is a whole number from 0 to 1e15");
    terms.seed = static_cast<std::uint64_t>(*value);
  }
  return terms;
}

}  // namespace

std::string to_text(const std::vector<PatientValue>& values) {
  std::string text;
  for (const PatientValue& v : values)
    text += (text.empty() ? "" : ",") + v.name + printed("=%.10g", v.value);
  return text;
}

Result<std::vector<PatientValue>> resolve_patient(const std::string& text,
                                                  const std::vector<JointParameter>& parameters) {
  std::vector<PatientValue> values;
  if (text.empty()) return values;
  const auto population = read_bundled_population();
  ARTUS_TRY(population);
  const auto terms = read_terms(text, *population);
  ARTUS_TRY(terms);
  values = terms->known;
  for (const PatientValue& v : terms->said) {
    ARTUS_TRY(check_value(v.name, v.value, *population, parameters));
    set_value(values, v.name, v.value);
  }
  if (terms->seed) values = draw_patient(*population, *terms->seed, values);
  std::vector<PatientValue> out;
  for (const PatientValue& v : values) {
    const Quantity* quantity = population->find(v.name);
    if (const JointParameter* p = find_parameter(parameters, v.name))
      out.push_back({v.name, std::clamp(v.value, p->least, p->most)});
    else if (quantity != nullptr && quantity->person)
      out.push_back(v);
  }
  return out;
}

std::vector<JointParameter> read_parameters(const toml::table& joint, Problems& problems) {
  std::vector<JointParameter> parameters;
  for (ParameterEntry& entry : read_entries_of(joint, problems))
    parameters.push_back(std::move(entry.parameter));
  return parameters;
}

std::vector<std::string> apply_patient(toml::table& joint, const std::vector<PatientValue>& patient,
                                       std::vector<std::string> variants, Problems& problems) {
  Problems told;  // of the entries: by read_parameters
  for (const ParameterEntry& entry : read_entries_of(joint, told)) {
    const auto at = std::find_if(patient.begin(), patient.end(), [&](const PatientValue& v) {
      return v.name == entry.parameter.name;
    });
    const bool said = at != patient.end();
    const bool chosen =
        std::find(variants.begin(), variants.end(), entry.variant) != variants.end();
    if (!said && !(chosen && entry.parameter.usual)) continue;
    const double value = said ? at->value : *entry.parameter.usual;
    for (const ParameterAction& action : entry.actions)
      apply_action(joint, action, value - entry.parameter.modelled, entry.parameter.name, problems);
    if (!entry.variant.empty() && value >= kYes && !chosen) variants.push_back(entry.variant);
  }
  std::sort(variants.begin(), variants.end());
  joint.erase("parameter");
  return variants;
}

}  // namespace artus
