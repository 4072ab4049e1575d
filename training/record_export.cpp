// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/training/record_export.h"

#include <algorithm>
#include <map>

#include "artus/detail/core/csv.h"
#include "artus/detail/core/printed.h"

namespace artus {
namespace {

using ByAttempt = std::map<std::string, std::vector<MetricValue>>;

Result<ByAttempt> metrics_of(Records& records, const AttemptFilter& filter) {
  auto values = records.metrics(filter);
  ARTUS_TRY(values);
  ByAttempt out;
  for (MetricValue& v : *values) out[v.attempt].push_back(std::move(v));
  return out;
}

/// What raters said of an attempt.
struct ByPeople {
  std::vector<nlohmann::json> ratings;
  std::vector<nlohmann::json> comments;
};
Result<std::map<std::string, ByPeople>> judged_by_people(Records& records) {
  const auto ratings = records.ratings("");
  ARTUS_TRY(ratings);
  const auto comments = records.comments("");
  ARTUS_TRY(comments);
  std::map<std::string, ByPeople> out;
  for (const RatingRecord& r : *ratings)
    out[r.attempt].ratings.push_back({{"rater", r.rater},
                                      {"instrument", r.instrument},
                                      {"item", r.item},
                                      {"value", r.value},
                                      {"blinded", r.blinded}});
  for (const CommentRecord& c : *comments)
    out[c.attempt].comments.push_back({{"person", c.person}, {"time_s", c.time}, {"text", c.text}});
  return out;
}

nlohmann::json listed(const std::vector<nlohmann::json>& objects) {
  auto out = nlohmann::json::array();
  for (const nlohmann::json& object : objects) out.push_back(object);
  return out;
}

}  // namespace

Result<nlohmann::json> export_json(Records& records, const AttemptFilter& filter) {
  const auto attempts = records.attempts(filter);
  ARTUS_TRY(attempts);
  auto judged = judged_by_people(records);
  ARTUS_TRY(judged);
  auto metrics = metrics_of(records, filter);
  ARTUS_TRY(metrics);
  auto out = nlohmann::json::array();
  for (const AttemptRecord& a : *attempts) {
    auto values = nlohmann::json::array();
    for (const MetricValue& m : (*metrics)[a.id])
      values.push_back({{"name", m.name},
                        {"role", m.role},
                        {"unit", m.unit},
                        {"value", m.value ? nlohmann::json(*m.value) : nlohmann::json()}});
    out.push_back({{"attempt", a.id},
                   {"person", a.person},
                   {"scenario", a.scenario},
                   {"scenario_hash", a.scenario_hash},
                   {"level", a.level},
                   {"started", a.started},
                   {"finished", !a.ended.empty()},
                   {"mode", a.mode},
                   {"aided", a.aided},
                   {"seed", a.seed},
                   {"duration_s", a.duration},
                   {"passed", a.passed},
                   {"score", a.score},
                   {"metrics", values},
                   {"ratings", listed((*judged)[a.id].ratings)},
                   {"comments", listed((*judged)[a.id].comments)}});
  }
  return out;
}

Result<std::string> export_csv(Records& records, const AttemptFilter& filter) {
  const auto attempts = records.attempts(filter);
  ARTUS_TRY(attempts);
  auto metrics = metrics_of(records, filter);
  ARTUS_TRY(metrics);
  std::string out =
      "person,scenario,attempt,started,finished,passed,score,metric,role,value,unit\n";
  for (const AttemptRecord& a : *attempts)
    for (const MetricValue& m : (*metrics)[a.id])
      out += quoted_csv(a.person) + ',' + quoted_csv(a.scenario) + ',' + a.id + ',' + a.started +
             ',' + (a.ended.empty() ? "0," : "1,") + (a.passed ? "1," : "0,") +
             to_exact_csv(a.score) + ',' + quoted_csv(m.name) + ',' + m.role + ',' +
             (m.value ? to_exact_csv(*m.value) : "") + ',' + m.unit + '\n';
  return out;
}

Result<std::string> export_tsv(Records& records, const AttemptFilter& filter) {
  const auto values = records.metrics(filter);
  ARTUS_TRY(values);
  std::string out = "MetricName\tMetricRoles\tMetricUnit\tMetricValue\n";
  for (const MetricValue& m : *values)
    if (m.value)
      out += m.name + '\t' + m.role + '\t' + m.unit + '\t' + to_exact_csv(*m.value) + '\n';
  return out;
}

namespace {

/// A statement's UUID: the same for the same attempt, so that one sent twice is one.
std::string statement_id(const std::string& attempt) {
  constexpr std::size_t kDigits = 16;
  std::string hex = text_hash("statement " + attempt).substr(0, kDigits) +
                    text_hash("of artus " + attempt).substr(0, kDigits);
  hex.resize(2 * kDigits, '0');
  hex[12] = '5';
  hex[16] = 'a';
  return hex.substr(0, 8) + '-' + hex.substr(8, 4) + '-' + hex.substr(12, 4) + '-' +
         hex.substr(16, 4) + '-' + hex.substr(20);
}

/// An absolute IRI as a web address: what a record store takes as somebody's home page.
bool is_address(const std::string& text) {
  const std::size_t begin = text.rfind("https://", 0) == 0  ? 8
                            : text.rfind("http://", 0) == 0 ? 7
                                                            : 0;
  return begin > 0 && text.size() > begin &&
         text.find_first_of(" \t\n<>\"{}|\\^`") == std::string::npos;
}

/// By ISO 8601, to the hundredth of a second: "PT12.5S".
std::string duration_of(double seconds) {
  std::string digits = printed("%.2f", std::max(0.0, seconds));
  digits.erase(digits.find_last_not_of('0') + 1);
  if (digits.back() == '.') digits.pop_back();
  return "PT" + digits + "S";
}

}  // namespace

Result<nlohmann::json> export_xapi(Records& records, const AttemptFilter& filter,
                                   const std::string& home) {
  if (!is_address(home))
    return fail(ErrorCode::malformed,
                "'" + home + "' is no address: write https:// and who gave the pseudonyms",
                "--home");
  const std::string iri = home + (home.back() != '/' ? "/" : "");
  const auto attempts = records.attempts(filter);
  ARTUS_TRY(attempts);
  auto metrics = metrics_of(records, filter);
  ARTUS_TRY(metrics);
  auto out = nlohmann::json::array();
  for (const AttemptRecord& a : *attempts) {
    if (a.ended.empty() || a.person.empty()) continue;
    const std::string verb = a.aided ? "attempted" : (a.passed ? "passed" : "failed");
    auto extensions = nlohmann::json::object();
    for (const MetricValue& m : (*metrics)[a.id])
      if (m.value) extensions[iri + "metric/" + m.name + "/" + m.role] = *m.value;
    nlohmann::json result = {{"duration", duration_of(a.duration)}, {"extensions", extensions}};
    if (!a.aided) {
      result["score"] = {{"scaled", a.score / 100}, {"raw", a.score}, {"min", 0}, {"max", 100}};
      result["success"] = a.passed;
    }
    out.push_back(
        {{"id", statement_id(a.id)},
         {"version", "1.0.3"},
         {"actor",
          {{"objectType", "Agent"}, {"account", {{"homePage", home}, {"name", a.person}}}}},
         {"verb", {{"id", "http://adlnet.gov/expapi/verbs/" + verb}, {"display", {{"en", verb}}}}},
         {"object",
          {{"objectType", "Activity"},
           {"id", iri + "scenario/" + a.scenario},
           {"definition",
            {{"type", "http://adlnet.gov/expapi/activities/simulation"},
             {"name", {{"en", a.scenario}}}}}}},
         {"result", result},
         {"timestamp", a.ended}});
  }
  return out;
}

}  // namespace artus
