// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/anatomy/source/joint_structure.h"

#include <algorithm>
#include <array>

#include "artus/detail/core/known_names.h"
#include "artus/detail/core/units.h"

namespace artus {
namespace {

constexpr double kThickestFilm = 10;  // units of the file; no film between neighbours is thicker
constexpr double kLongest = 1e4;      // units of the file; no length of a joint is longer
constexpr double kLargestInflation = 1000;  // ml, more than any space of a joint takes

/// A length key of the file: positive, in metres.
double required_length(TomlTable& toml, std::string_view key, double unit) {
  const double value = toml.required_number(key, 0, kLongest, unit);
  if (value == 0 && toml.has(key)) toml.problem_at(key, "must be greater than 0");
  return value;
}

SurfaceFile read_surface_file(TomlTable& toml, double unit) {
  SurfaceFile surface;
  surface.file = toml.required_text("file");
  surface.unit = length_unit(toml, "units", unit);
  surface.has_own_unit = toml.has("units");
  surface.repair = toml.text("repair").value_or("auto");
  if (surface.repair != "auto" && surface.repair != "none" && surface.repair != "wrap")
    toml.problem_at("repair", "must be \"auto\", \"none\" or \"wrap\"");
  surface.thicken = toml.number("thicken", 0, kLongest, unit).value_or(0);
  surface.grow = toml.number("grow", -kLongest, kLongest, unit).value_or(0);
  return surface;
}

ShellConstruct read_shell(TomlTable& toml, double unit) {
  ShellConstruct shell;
  shell.inside = toml.text("inside").value_or("");
  shell.thickness = required_length(toml, "thickness", unit);
  return shell;
}

CapConstruct read_cap(TomlTable& toml, double unit) {
  CapConstruct cap;
  cap.on = toml.required_text("on");
  cap.near = toml.required_texts("near");
  cap.within = required_length(toml, "within", unit);
  cap.thickness = required_length(toml, "thickness", unit);
  return cap;
}

GapConstruct read_gap(TomlTable& toml, double unit) {
  GapConstruct gap;
  gap.roof = toml.required_texts("roof");
  gap.floor = toml.required_texts("floor");
  gap.thickness = required_length(toml, "thickness", unit);
  gap.within = required_length(toml, "within", unit);
  gap.centre = toml.required_vector("centre", unit);
  gap.radius = required_length(toml, "radius", unit);
  gap.edge = toml.number("edge", 0, kLongest, unit).value_or(0);
  gap.inflation = toml.number("inflation_ml", 0, kLargestInflation, kCubicCentimetre).value_or(0);
  return gap;
}

EndConstruct read_end(TomlTable& toml, double unit) {
  EndConstruct end;
  end.of = toml.required_text("of");
  end.toward = toml.required_text("toward");
  end.within = required_length(toml, "within", unit);
  end.insertion = toml.vector("insertion", unit);
  return end;
}

/// A construct's inline table, read by `read` and checked for unknown keys.
template <class Read>
auto read_construct(TomlTable& structure, const char* key, double unit, Read read) {
  const toml::table empty;
  const auto* table = structure.table(key);
  TomlTable toml(table != nullptr ? *table : empty, structure.what() + " " + key,
                 structure.problems());
  auto construct = read(toml, unit);
  toml.finish();
  return construct;
}

void read_shape(TomlTable& toml, double unit, Structure& structure) {
  constexpr std::array<const char*, 5> kShapes{"file", "shell", "cap", "gap", "end"};
  std::string found;
  std::size_t n_found = 0;
  for (const char* shape : kShapes) {
    if (!toml.has(shape)) continue;
    found = shape;
    ++n_found;
  }
  if (n_found != 1) {
    toml.problem(
        "needs exactly one of 'file', 'shell', 'cap', 'gap' and 'end' to say what its shape is");
    for (const char* shape : kShapes)  // makes the keys known, so that they are told once
      if (std::string_view(shape) != "file") static_cast<void>(toml.table(shape));
    static_cast<void>(toml.text("file"));
    return;
  }
  if (found == "file") structure.shape = read_surface_file(toml, unit);
  if (found == "shell") structure.shape = read_construct(toml, "shell", unit, read_shell);
  if (found == "cap") structure.shape = read_construct(toml, "cap", unit, read_cap);
  if (found == "gap") structure.shape = read_construct(toml, "gap", unit, read_gap);
  if (found == "end") structure.shape = read_construct(toml, "end", unit, read_end);
}

void read_facets(TomlTable& toml, double unit, Structure& structure) {
  structure.facet_size = toml.number("facet_size", 0, kLongest, unit).value_or(0);
  structure.facet_distance = toml.number("facet_distance", 0, kLongest, unit).value_or(0);
}

std::set<std::string, std::less<>> tissue_names(const JointFile& joint) {
  std::set<std::string, std::less<>> names;
  for (const auto& t : joint.tissues) names.insert(t.name);
  return names;
}

/// The structures that can be made one after the other; what runs in a circle is left out.
std::set<std::string, std::less<>> find_makeable(const JointFile& joint) {
  std::set<std::string, std::less<>> made;
  for (bool more = true; more;) {
    more = false;
    for (const auto& s : joint.structures) {
      const auto names = names_of(s);
      const bool is_ready = std::all_of(names.begin(), names.end(), [&](const std::string& n) {
        return made.contains(n) || n == s.name;  // naming itself is a problem told apart
      });
      if (is_ready) more = made.insert(s.name).second || more;
    }
  }
  return made;
}

/// Whether `s` is the end of a structure that is itself a construct, and does not say where.
bool lacks_insertion(const JointFile& joint, const Structure& s) {
  const auto* end = std::get_if<EndConstruct>(&s.shape);
  if (end == nullptr || end->insertion) return false;
  const auto of = std::find_if(joint.structures.begin(), joint.structures.end(),
                               [&](const Structure& other) { return other.name == end->of; });
  return of != joint.structures.end() && !std::holds_alternative<SurfaceFile>(of->shape);
}

void check_circles(const JointFile& joint, const std::vector<toml::source_region>& places,
                   Problems& problems) {
  const auto makeable = find_makeable(joint);
  for (std::size_t i = 0; i < joint.structures.size(); ++i)
    if (!makeable.contains(joint.structures[i].name))
      problems.add(places[i], "structure '" + joint.structures[i].name +
                                  "': is made from structures that are made from each other in a "
                                  "circle");
}

}  // namespace

std::vector<std::string> names_of(const Structure& structure) {
  std::vector<std::string> names;
  if (const auto* shell = std::get_if<ShellConstruct>(&structure.shape)) {
    if (!shell->inside.empty()) names.push_back(shell->inside);
  } else if (const auto* cap = std::get_if<CapConstruct>(&structure.shape)) {
    names = cap->near;
    names.push_back(cap->on);
  } else if (const auto* gap = std::get_if<GapConstruct>(&structure.shape)) {
    names = gap->roof;
    names.insert(names.end(), gap->floor.begin(), gap->floor.end());
  } else if (const auto* end = std::get_if<EndConstruct>(&structure.shape)) {
    names = {end->of, end->toward};
  }
  return names;
}

double length_unit(TomlTable& toml, std::string_view key, double default_unit) {
  const auto text = toml.text(key);
  if (!text) return default_unit;
  if (*text == "mm") return 1e-3;
  if (*text == "cm") return 1e-2;
  if (*text == "m") return 1;
  toml.problem_at(key, "must be \"mm\", \"cm\" or \"m\"");
  return default_unit;
}

Structure read_structure(const toml::table& table, std::size_t number, double unit,
                         Problems& problems) {
  const auto named = table["name"].value<std::string>();
  TomlTable toml(table,
                 named ? "structure '" + *named + "'" : "structure " + std::to_string(number),
                 problems);
  Structure structure;
  structure.line = static_cast<int>(table.source().begin.line);
  structure.name = toml.required_text("name");
  if (named && !named->empty() && !is_plain_name(*named, '_'))
    toml.problem_at("name", "may contain only a-z, 0-9 and _");
  structure.tissue = toml.required_text("tissue");
  read_shape(toml, unit, structure);
  read_facets(toml, unit, structure);
  structure.partition = toml.text("partition").value_or("");
  if (!structure.partition.empty() && !std::holds_alternative<SurfaceFile>(structure.shape))
    toml.problem_at("partition", "is for structures with a file: a construct has no borders yet");
  structure.fibre_axis = toml.vector("fibre_axis");
  if (structure.fibre_axis) {
    if (structure.fibre_axis->norm() > 0)
      structure.fibre_axis->normalize();
    else
      toml.problem_at("fibre_axis", "must not be zero");
  }
  const std::string course = toml.text("fibre_course").value_or("ends");
  if (course == "layer")
    structure.fibre_course = FibreCourse::layer;
  else if (course != "ends")
    toml.problem_at("fibre_course", "must be \"ends\" or \"layer\", not \"" + course + "\"");
  if (course == "layer" && !structure.fibre_axis)
    toml.problem_at("fibre_course", "\"layer\" needs fibre_axis = [x, y, z], which it follows");
  toml.finish();
  return structure;
}

Structure read_body(const toml::table& table, double unit, std::string& filler_name,
                    Problems& problems) {
  TomlTable toml(table, "body", problems);
  Structure body;
  body.line = static_cast<int>(table.source().begin.line);
  body.name = "body";
  body.tissue = toml.required_text("tissue");
  SurfaceFile surface = read_surface_file(toml, unit);
  surface.cuts = toml.text("cuts").value_or("");
  body.shape = std::move(surface);
  read_facets(toml, unit, body);
  filler_name = toml.text("filler").value_or(body.tissue);
  if (!filler_name.empty() && !is_plain_name(filler_name, '_'))
    toml.problem_at("filler", "may contain only a-z, 0-9 and _");
  toml.finish();
  return body;
}

std::vector<Partition> read_partitions(TomlTable& toml, double unit) {
  std::vector<Partition> partitions;
  const toml::table* all = toml.table("partition");
  if (all == nullptr) return partitions;
  for (const auto& [key, node] : *all) {
    const toml::table* table = node.as_table();
    if (table == nullptr) {
      toml.problems().add(node, "partition: give it as [partition.NAME] with film = 0.1");
      continue;
    }
    TomlTable one(*table, "partition '" + std::string(key.str()) + "'", toml.problems());
    partitions.push_back(
        {std::string(key.str()), one.required_number("film", 0, kThickestFilm, unit)});
    one.finish();
  }
  return partitions;
}

void check_structures(const JointFile& joint, const std::vector<toml::source_region>& places,
                      Problems& problems) {
  const auto tissues = tissue_names(joint);
  std::set<std::string, std::less<>> taken{"outside", "beyond", "body", joint.filler_name};
  std::set<std::string, std::less<>> names;
  for (const auto& s : joint.structures) names.insert(s.name);
  if (!joint.body.tissue.empty() && !tissues.contains(joint.body.tissue))
    problems.add(toml::source_region{}, "body: unknown tissue '" + joint.body.tissue + "'" +
                                            did_you_mean(joint.body.tissue, tissues));
  bool all_known = true;
  for (std::size_t i = 0; i < joint.structures.size(); ++i) {
    const auto& s = joint.structures[i];
    const auto add = [&](const std::string& message) {
      problems.add(places[i], "structure '" + s.name + "': " + message);
    };
    if (!s.name.empty() && !taken.insert(s.name).second)
      add("the name is already used; give each structure, the filler and the body its own");
    if (!s.tissue.empty() && !tissues.contains(s.tissue))
      add("unknown tissue '" + s.tissue + "'" + did_you_mean(s.tissue, tissues) +
          "; add it to the tissue library or under [tissue." + s.tissue + "] in this file");
    const auto partitions = item_names(joint.partitions);
    if (!s.partition.empty() &&
        std::find(partitions.begin(), partitions.end(), s.partition) == partitions.end())
      add("names the partition '" + s.partition + "', which is not one of this file" +
          did_you_mean(s.partition, partitions) + "; declare it by [partition." + s.partition +
          "] with film = 0.1");
    for (const auto& name : names_of(s)) {
      if (name.empty()) continue;
      if (name == s.name)
        add("a construct cannot name itself");
      else if (!names.contains(name))
        add("names '" + name + "', which is not a structure of this file" +
            did_you_mean(name, names));
      all_known = all_known && names.contains(name);
    }
    if (lacks_insertion(joint, s))
      add("'of' names '" + std::get<EndConstruct>(s.shape).of +
          "', which has no file: say where the insertion is (insertion = [x, y, z])");
  }
  if (all_known) check_circles(joint, places, problems);
}

}  // namespace artus
