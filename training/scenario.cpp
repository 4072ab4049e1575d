// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/training/scenario.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <sstream>
#include <utility>

#include "artus/detail/anatomy/body/joint_path.h"
#include "artus/detail/core/known_names.h"
#include "artus/detail/core/text_file.h"
#include "artus/detail/core/toml_table.h"
#include "artus/detail/core/units.h"
#include "artus/detail/training/bundled_scenarios.h"
#include "artus/detail/training/metrics/attempt_metrics.h"

namespace artus {
namespace {

std::vector<std::string> step_names() {
  return {"ask:side",      "ask:allergy",   "ask:consent",   "ask:anticoagulation",
          "ask:infection", "auto:doppler",  "auto:entry",    "auto:tip_seen",
          "auto:placed",   "auto:injected", "auto:withdrawn"};
}

/// Why a ball cannot lie where it should in what there is so far; empty: it can.
std::string why_not(const Ball& ball, const GelBlock& gel) {
  constexpr double kApart = 0.1e-3;  // m
  const double reach = ball.radius + kApart;
  if (layer_of(gel, ball) == gel.layers.size())
    return "it must lie wholly in one layer and in the block";
  for (const Ball& other : gel.balls)
    if ((other.centre - ball.centre).norm() < reach + other.radius)
      return "it must lie apart from the other balls";
  return "";
}

void read_gel(TomlTable& toml, Scenario& scenario, Problems& problems) {
  if (!toml.has("gel")) return;
  GelBlock gel;
  const toml::table* table = toml.table("gel");
  if (table == nullptr) return;
  TomlTable block(*table, "gel", problems);
  gel.width = block.number("width", 20, 500, kMillimetre).value_or(gel.width);
  for (const toml::table* layer : block.tables("layer")) {
    TomlTable one(*layer, "gel layer", problems);
    FlatLayer flat;
    flat.tissue = one.required_text("tissue");
    flat.thickness = one.required_number("thickness", 0.1, 200, kMillimetre);
    one.finish();
    gel.layers.push_back(flat);
  }
  if (gel.layers.empty()) block.problem("[gel] needs at least one [[gel.layer]]");
  for (const toml::table* ball : block.tables("ball")) {
    TomlTable one(*ball, "gel ball", problems);
    Ball round;
    round.tissue = one.required_text("tissue");
    round.centre = one.required_vector("centre", kMillimetre);
    round.radius = one.required_number("radius", 0.5, 50, kMillimetre);
    one.finish();
    const std::string problem = why_not(round, gel);
    if (!problem.empty()) one.problem(problem);
    gel.balls.push_back(round);
  }
  block.finish();
  scenario.gel = gel;
}

void read_instruments(TomlTable& toml, Scenario& s, Problems& problems) {
  if (const toml::table* table = toml.table("probe")) {
    TomlTable probe(*table, "probe", problems);
    s.transducer = probe.text("transducer").value_or(s.transducer);
    s.depth = probe.number("depth", 10, 300, kMillimetre).value_or(s.depth);
    const Vec3 p = probe.required_vector("position", kMillimetre);
    const Vec3 z = probe.required_vector("direction");
    const Vec3 x = probe.vector("lateral").value_or(Vec3::Zero());
    if (z.norm() < 1e-9)
      probe.problem_at("direction", "it must not be zero");
    else
      s.X_JP = make_pose(p, z, x);
    probe.finish();
  } else {
    toml.problem("[probe] is missing");
  }
  if (const toml::table* table = toml.table("needle")) {
    TomlTable needle(*table, "needle", problems);
    const double gauge = needle.number("gauge", 18, 25).value_or(s.gauge);
    s.gauge = static_cast<int>(gauge);
    if (!needle_of_gauge(s.gauge) || gauge != s.gauge)
      needle.problem_at("gauge", "it must be 18, 20, 21, 22, 23 or 25");
    s.needle_length = needle.number("length", 10, 200, kMillimetre).value_or(s.needle_length);
    needle.finish();
  }
}

void read_syringe(TomlTable& toml, Scenario& s, Problems& problems) {
  const toml::table* table = toml.table("syringe");
  if (table == nullptr) return;
  TomlTable syringe(*table, "syringe", problems);
  s.syringe.volume = syringe.required_number("volume_ml", 0.01, 60, kCubicCentimetre);
  s.syringe.rate = syringe.number("rate_ml_s", 0.001, 10, kCubicCentimetre).value_or(0.1e-6);
  s.syringe.barrel = syringe.number("barrel_ml", 0.5, 60, kCubicCentimetre).value_or(0);
  s.syringe.liquid = syringe.text("liquid").value_or(s.syringe.liquid);
  syringe.finish();
  SyringeChoice choice = syringe_of(s);
  if (const auto made = make_plunger_params(choice, s.needle_length); !made)
    syringe.problem(made.error().message);
}

/// A task of looking has no needle, and nothing that one needs.
void read_find(TomlTable& toml, Scenario& s) {
  if (!toml.has("find")) return;
  constexpr std::size_t kMax = 12;
  s.find = toml.required_texts("find");
  if (s.find.empty() || s.find.size() > kMax)
    toml.problem_at("find", "it must name 1 to 12 structures");
  for (const char* key : {"needle", "target", "entry", "avoid", "syringe"})
    if (toml.has(key))
      toml.problem_at(key, "cannot be combined with find, a task for the probe alone");
}

void read_goals(TomlTable& toml, Scenario& s, Problems& problems) {
  if (!s.find.empty()) return;
  if (const toml::table* table = toml.table("target")) {
    TomlTable target(*table, "target", problems);
    s.target.structure = target.text("structure").value_or("");
    s.target.point = target.required_vector("point", kMillimetre);
    target.finish();
  } else {
    toml.problem("[target] is missing");
  }
  for (const toml::table* table : toml.tables("avoid")) {
    TomlTable zone(*table, "avoid", problems);
    ScenarioAvoid avoid;
    avoid.structure = zone.required_text("structure");
    avoid.margin = zone.number("margin", 0, 50, kMillimetre).value_or(0);
    avoid.fatal = zone.boolean("fatal").value_or(false);
    zone.finish();
    s.avoid.push_back(avoid);
  }
  if (const toml::table* table = toml.table("entry")) {
    TomlTable entry(*table, "entry", problems);
    s.entry.centre = entry.required_vector("centre", kMillimetre);
    s.entry.radius = entry.number("radius", 0.5, 100, kMillimetre).value_or(s.entry.radius);
    s.entry.plane = entry.text("plane").value_or(s.entry.plane);
    if (s.entry.plane != "in" && s.entry.plane != "out" && s.entry.plane != "free")
      entry.problem_at("plane", "it must be in, out or free");
    s.entry.min_angle = entry.number("angle_from", 0, 90, kDegree).value_or(0);
    s.entry.max_angle = entry.number("angle_to", 0, 90, kDegree).value_or(90 * kDegree);
    if (s.entry.min_angle > s.entry.max_angle)
      entry.problem_at("angle_from", "it must not be above angle_to");
    entry.finish();
  } else {
    toml.problem("[entry] is missing");
  }
}

void read_aids(TomlTable& toml, Scenario& s, Problems& problems) {
  const toml::table* table = toml.table("aids");
  if (table == nullptr) return;
  TomlTable aids(*table, "aids", problems);
  for (const std::string& name : aid_names())
    if (const auto value = aids.number(name, 0, 1)) s.aids.push_back({name, *value});
  s.fade = aids.text("fade").value_or(s.fade);
  if (s.fade != "success" && s.fade != "trials" && s.fade != "none")
    aids.problem_at("fade", "it must be success, trials or none");
  aids.finish();
}

bool is_metric(const std::string& name, const std::vector<std::string>& known) {
  return std::find(known.begin(), known.end(), name.substr(0, name.find(':'))) != known.end() ||
         name.rfind("force_", 0) == 0;
}

/// The entry's radius and angles as marks, where the file has none of its own on these metrics.
void add_own_marks(Scenario& s) {
  const auto own = [&s](const std::string& metric) {
    return std::any_of(s.pass.begin(), s.pass.end(),
                       [&](const Mark& mark) { return mark.metric == metric; });
  };
  const bool judge_angle = !own("entry_angle_deg");
  const auto add = [&s](const char* metric, const char* relation, double bound) {
    std::ostringstream text;
    text << relation << ' ' << bound;
    if (const auto mark = parse_mark(metric, text.str())) s.pass.push_back(*mark);
  };
  const bool fatal = std::any_of(s.avoid.begin(), s.avoid.end(),
                                 [](const ScenarioAvoid& avoid) { return avoid.fatal; });
  if (fatal && !own("avoid_fatal")) add("avoid_fatal", "==", 0);
  if (!own("withdrawn")) add("withdrawn", "==", 1);
  if (!own("done_s")) add("done_s", "<=", s.time_limit);
  if (!own("entry_offset_mm")) add("entry_offset_mm", "<=", s.entry.radius / kMillimetre);
  if (judge_angle && s.entry.min_angle > 0)
    add("entry_angle_deg", ">=", s.entry.min_angle / kDegree);
  if (judge_angle && s.entry.max_angle < 90 * kDegree)
    add("entry_angle_deg", "<=", s.entry.max_angle / kDegree);
}

void read_marks(TomlTable& toml, Scenario& s, Problems& problems) {
  const std::vector<std::string> known = metric_names();
  if (const toml::table* table = toml.table("pass")) {
    for (const auto& [key, node] : *table) {
      const std::string name(key.str());
      const auto text = node.value<std::string>();
      if (!is_metric(name, known))
        problems.add(node, "pass: '" + name + "' is not a metric" + did_you_mean(name, known));
      const auto mark = parse_mark(name, text.value_or(""));
      if (!mark)
        problems.add(node, "pass: " + mark.error().to_string());
      else
        s.pass.push_back(*mark);
    }
  }
  if (s.pass.empty()) toml.problem("[pass] must hold at least one mark");
  if (s.find.empty()) add_own_marks(s);
  if (const toml::table* table = toml.table("score")) {
    for (const auto& [key, node] : *table) {
      const std::string name(key.str());
      const auto weight = node.value<double>();
      if (!weight || !(*weight >= 0) || *weight > 1000)
        problems.add(node, "score: the weight of '" + name + "' must be a number from 0 to 1000");
      else
        s.score.push_back({name, *weight});
      const bool marked = std::any_of(s.pass.begin(), s.pass.end(),
                                      [&](const Mark& m) { return m.metric == name; });
      if (!marked) problems.add(node, "score: '" + name + "' is not among the marks of [pass]");
    }
  }
}

void read_head(TomlTable& toml, Scenario& s) {
  if (toml.required_number("format", 1, 1) != 1) toml.problem_at("format", "it must be 1");
  s.name = toml.required_text("name");
  if (!is_plain_name(s.name, '-')) toml.problem_at("name", "it must be made of a-z, 0-9 and -");
  s.title = toml.required_text("title");
  s.title_fr = toml.text("title_fr").value_or("");
  s.joint = toml.text("joint").value_or("");
  if (toml.has("variants")) s.variants = toml.required_texts("variants");
  if (s.joint.empty() && !s.variants.empty())
    toml.problem_at("variants", "variants need a joint, and the scenario has none");
  s.patient = toml.text("patient").value_or("");
  if (s.joint.empty() && !s.patient.empty())
    toml.problem_at("patient", "a patient needs a joint, and the scenario has none");
  s.procedure = toml.text("procedure").value_or("");
  s.level = static_cast<int>(toml.required_number("level", 0, 8));
  s.seed = static_cast<std::uint64_t>(toml.number("seed", 0, 1e15).value_or(1));
  s.time_limit = toml.number("time_limit", 5, 3600).value_or(s.time_limit);
  if (toml.has("steps")) s.steps = toml.required_texts("steps");
  const auto known = step_names();
  for (const std::string& step : s.steps)
    if (std::find(known.begin(), known.end(), step) == known.end())
      toml.problem_at("steps", "'" + step + "' is not a step" + did_you_mean(step, known));
}

}  // namespace

std::size_t layer_of(const GelBlock& gel, const Ball& ball) {
  constexpr double kApart = 0.1e-3;  // m
  const double reach = ball.radius + kApart;
  if (std::max(std::abs(ball.centre.x()), std::abs(ball.centre.y())) + reach > gel.width / 2)
    return gel.layers.size();
  double top = 0;
  for (std::size_t i = 0; i < gel.layers.size(); ++i) {
    const double bottom = top + gel.layers[i].thickness;
    if (ball.centre.z() - reach >= top && ball.centre.z() + reach <= bottom) return i;
    top = bottom;
  }
  return gel.layers.size();
}

std::vector<std::string> aid_names() {
  return {"needle_overlay", "tip_marker",   "plane_beam", "labels",
          "target_glow",    "haptic_guide", "haptic_wall"};
}

bool Scenario::aided() const noexcept {
  return std::any_of(aids.begin(), aids.end(), [](const Aid& aid) { return aid.value > 0; });
}

std::filesystem::path Scenario::body() const {
  std::filesystem::path body = joint;
  for (const std::string& variant : variants) body = with_variant(body, variant);
  return patient.empty() ? body : with_patient(body, patient);
}

SyringeChoice syringe_of(const Scenario& scenario) {
  SyringeChoice choice;
  choice.gauge = scenario.gauge;
  if (scenario.syringe.volume <= 0) return choice;
  choice.liquid = scenario.syringe.liquid;
  choice.filled = scenario.syringe.volume;
  choice.barrel = scenario.syringe.barrel;
  return choice;
}

double faded(double value, int successes) noexcept {
  const double left = value * std::pow(0.7, successes);
  return left < 0.1 ? 0 : left;
}

Result<Scenario> parse_scenario(std::string_view text, const std::string& name) {
  const auto table = parse_toml(text, name);
  ARTUS_TRY(table);
  Problems problems;
  TomlTable toml(*table, "scenario", problems);
  Scenario scenario;
  scenario.text = text;
  read_head(toml, scenario);
  read_gel(toml, scenario, problems);
  if (scenario.joint.empty() != scenario.gel.has_value())
    toml.problem("give either a joint or a [gel]");
  read_find(toml, scenario);
  read_instruments(toml, scenario, problems);
  read_syringe(toml, scenario, problems);
  read_goals(toml, scenario, problems);
  read_aids(toml, scenario, problems);
  read_marks(toml, scenario, problems);
  toml.finish();
  if (!problems.empty()) return problems.refusal(ErrorCode::invalid, name);
  return scenario;
}

Result<Scenario> read_scenario(const std::filesystem::path& file) {
  const auto text = read_bytes(file);
  ARTUS_TRY(text);
  return parse_scenario(*text, file.string());
}

std::vector<std::string_view> bundled_scenario_texts() {
  const auto texts = bundled_scenarios();
  return {texts.begin(), texts.end()};
}

Result<Scenario> find_scenario(const std::string& name_or_file) {
  std::string names;
  for (const std::string_view text : bundled_scenario_texts()) {
    auto scenario = parse_scenario(text, "bundled");
    ARTUS_TRY(scenario);
    if (scenario->name == name_or_file) return scenario;
    names += (names.empty() ? "" : ", ") + scenario->name;
  }
  std::error_code unknown;
  if (std::filesystem::exists(name_or_file, unknown)) return read_scenario(name_or_file);
  return fail(ErrorCode::not_found, "neither a file nor a bundled scenario; bundled are: " + names,
              name_or_file);
}

}  // namespace artus
