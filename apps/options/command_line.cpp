// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/apps/options/command_line.h"

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <utility>

#include <CLI/CLI.hpp>

#include "artus/detail/core/check.h"

namespace artus {

Option* Option::required(bool value) {
  option_->required(value);
  return this;
}

Option* Option::check(const FlagCheck& check) {
  option_->check(CLI::Validator(check.problem, check.wanted));
  return this;
}

Option* Option::one_of(const std::vector<std::string>& values) {
  option_->check(CLI::IsMember(values));
  return this;
}

Option* Option::capture_default_str() {
  option_->capture_default_str();
  return this;
}

Option* Option::group(const std::string& heading) {
  option_->group(heading);
  return this;
}

Option* Option::description(const std::string& text) {
  option_->description(text);
  return this;
}

Option* Option::expected(int count) {
  option_->expected(count);
  return this;
}

Option* Option::needs(const Option* other) {
  option_->needs(other->option_);
  return this;
}

Command::Command(const std::string& description)
    : program_(std::make_unique<CLI::App>(description)), app_(program_.get()) {}

Command::Command(CLI::App* app) : app_(app) {}

Command::~Command() = default;

Command* Command::add_subcommand(const std::string& name, const std::string& description) {
  CLI::App* added = app_->add_subcommand(name, description);
  added->group(group_.empty() ? "Subcommands" : group_);  // else it takes that of the command above
  if (!program_)
    added->preparse_callback([above = app_](std::size_t /*left*/) {
      for (CLI::Option* option : above->get_options()) option->required(false);
    });
  return commands_.emplace_back(std::make_unique<Command>(added)).get();
}

std::vector<std::string> Command::subcommands() const {
  std::vector<std::string> names;
  for (const auto& command : commands_) names.push_back(command->app_->get_name());
  return names;
}

Command& Command::subcommand(const std::string& name) {
  const auto found = std::find_if(commands_.begin(), commands_.end(), [&](const auto& command) {
    return command->app_->get_name() == name;
  });
  ARTUS_REQUIRE(found != commands_.end(), "there is no such subcommand");
  return **found;
}

template <typename Value>
Option* Command::add_option(const std::string& names, Value& value, const std::string& help) {
  return &options_.emplace_back(app_->add_option(names, value, help));
}
// Each kind of value that a flag of ours has, compiled here once.
#define ARTUS_OPTION_OF(...) \
  template Option* Command::add_option(const std::string&, __VA_ARGS__&, const std::string&)
ARTUS_OPTION_OF(std::string);
ARTUS_OPTION_OF(std::filesystem::path);
ARTUS_OPTION_OF(double);
ARTUS_OPTION_OF(int);
ARTUS_OPTION_OF(std::int64_t);
ARTUS_OPTION_OF(std::uint64_t);
ARTUS_OPTION_OF(std::optional<double>);
ARTUS_OPTION_OF(std::optional<int>);
ARTUS_OPTION_OF(std::optional<std::string>);
ARTUS_OPTION_OF(std::vector<double>);
ARTUS_OPTION_OF(std::vector<std::string>);
#undef ARTUS_OPTION_OF

Option* Command::add_flag(const std::string& names, bool& value, const std::string& help) {
  return &options_.emplace_back(app_->add_flag(names, value, help));
}

Option* Command::get_option(const std::string& name) {
  return &options_.emplace_back(app_->get_option(name));
}

void Command::footer(const std::string& text) {
  app_->footer(text);
}

void Command::set_version_flag(const std::string& name, const std::string& text) {
  app_->set_version_flag(name, text);
}

void Command::require_subcommand(int count) {
  app_->require_subcommand(count);
}

void Command::callback(std::function<void()> body) {
  app_->callback([app = app_, body = std::move(body)] {
    if (app->get_subcommands().empty()) body();
  });
}

bool Command::parse(int argc, const char* const* argv, int& exit_code) {
  line_.clear();
  for (int i = 1; i < argc; ++i) line_.append(i > 1 ? " " : "").append(argv[i]);
  try {
    app_->parse(argc, argv);
    return true;
  } catch (const CLI::ParseError& e) {
    exit_code = app_->exit(e);
    return false;
  }
}

}  // namespace artus
