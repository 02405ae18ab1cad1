#include "command/command.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <iostream>

#include "command/describe.h"
#include "command/exit_status.h"
#include "command/spelling.h"
#include "commit/commit.h"
#include "import/input_error.h"
#include "radar/radar.h"

namespace radar::tools {

namespace {

constexpr const char* kCompletionExamples = R"(Examples:
  source <(cyber-radar completion bash)      in ~/.bashrc, unless an installation brought it
  cyber-radar completion zsh > ~/.zfunc/_cyber-radar)";

std::string inDigits(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.15g", value);
  return text;
}

std::vector<std::string> optionsOf(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::Option* option : app.get_options()) {
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  }
  return names;
}

// The first word that the command does not know, and what stands after it unread, as it was typed.
std::string unknownIn(const CLI::App& app) {
  const std::vector<std::string> unread = app.remaining();
  if (unread.empty()) return "";
  const std::string& word = unread[0];
  const std::string quoted = "got \"" + printable(word, 60) + "\"";
  if (word.starts_with('-')) return "expected one of its options, " + quoted + nearest(word, optionsOf(app));
  if (app.get_require_subcommand_min() > 0) return "expected a command, " + quoted + nearest(word, commandNames(app));
  return "expected nothing more, got \"" + printable(joined(unread, " "), 60) + "\"";
}

std::string inWords(const CLI::App* app, const CLI::Error& error) {
  std::string name = app->get_name(), unknown = unknownIn(*app);
  while (!app->get_subcommands().empty() && unknown.empty()) {
    app = app->get_subcommands().back();
    name += " " + app->get_name();
    unknown = unknownIn(*app);
  }
  const bool lacksCommand = app->get_require_subcommand_min() > 0;
  const std::string problem = !unknown.empty() ? unknown : lacksCommand ? "expected a command, got none" : error.what();
  return name + ": " + problem + "\n" + name + " --help explains what it takes.\n";
}

// An empty text as a check's answer means that the value is right.
void check(CLI::Option& option, std::function<std::string(const std::string&)> problemOf) {
  option.check(CLI::Validator([=](std::string& value) { return problemOf(value); }, ""));
}

CLI::Option* added(CLI::App& app, const std::string& name, const OptionTarget& target, const std::string& about) {
  return std::visit(
      [&](const auto& to) -> CLI::Option* {
        using To = std::decay_t<decltype(to)>;
        if constexpr (std::is_same_v<To, bool*>) {
          return app.add_flag(name, *to, about);
        } else if constexpr (std::is_same_v<To, std::function<void()>>) {
          return app.add_flag_callback(name, to, about);
        } else if constexpr (std::is_same_v<To, std::function<void(double)>>) {
          return app.add_option_function<double>(name, to, about)->type_name("X");
        } else if constexpr (std::is_same_v<To, std::function<void(const std::string&)>>) {
          return app.add_option_function<std::string>(name, to, about);
        } else {
          return app.add_option(name, *to, about);
        }
      },
      target);
}

// Whether its default says something.
bool hasDefault(const OptionTarget& target) {
  if (const auto* number = std::get_if<uint32_t*>(&target)) return **number != kNone;
  if (const auto* text = std::get_if<std::string*>(&target)) return !(*text)->empty();
  if (const auto* words = std::get_if<std::vector<std::string>*>(&target)) return !(*words)->empty();
  if (const auto* numbers = std::get_if<std::vector<uint32_t>*>(&target)) return !(*numbers)->empty();
  return std::holds_alternative<uint64_t*>(target) || std::holds_alternative<double*>(target);
}

/// A full disk shows only now: what was printed stayed in memory.
void finishOutput() {
  if (!std::cout.flush()) throw std::runtime_error("standard output: expected a place to write to, got an error");
}

}  // namespace

Option Option::required() {
  option_->required();
  return *this;
}

Option Option::value(const std::string& name) {
  option_->type_name(name);
  return *this;
}

Option Option::oneOf(const std::vector<std::string>& words) {
  option_->type_name(joined(words, "|"));
  check(*option_, [=](const std::string& value) {
    if (std::ranges::find(words, value) != words.end()) return std::string();
    const std::string near = nearest(value, words);
    return "expected " + (near.empty() ? "one of " + joined(words, ", ") : "another word") + ", got \"" +
           printable(value, 60) + "\"" + near;
  });
  return *this;
}

Option Option::within(double least, double most) {
  const std::string expected =
      std::isinf(most) ? inDigits(least) + " or more" : "from " + inDigits(least) + " to " + inDigits(most);
  check(*option_, [=](const std::string& text) {
    double value = NAN;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    const bool isNumber = error == std::errc() && end == text.data() + text.size();
    if (isNumber && value >= least && value <= most) return std::string();
    return "expected a number " + (std::isinf(most) ? "of " : std::string()) + expected + ", got \"" +
           printable(text, 60) + "\"";
  });
  return *this;
}

Option Option::list() {
  option_->delimiter(',')->allow_extra_args(false);  // else it takes the arguments behind it
  return *this;
}

Option Option::count(int least, int most) {
  option_->expected(least, most);
  return *this;
}

Option Option::count(int exactly) {
  option_->type_size(exactly)->expected(1);
  return *this;
}

bool Option::given() const {
  return option_->count() > 0;
}

Command Command::add(const std::string& name, const std::string& about, const std::string& examples) {
  app_->require_subcommand(1);
  CLI::App* command = app_->add_subcommand(name, about);
  command->footer(examples);
  return {*command, *chosen_};
}

Option Command::option(const std::string& name, OptionTarget target, const std::string& about) {
  CLI::Option* option = added(*app_, name, target, about);
  if (hasDefault(target)) option->capture_default_str();
  return Option(*option);
}

void Command::run(std::function<int()> run) {
  app_->callback([chosen = chosen_, run = std::move(run)] { *chosen = run; });
}

Program::Program(const std::string& name, const std::string& about, const std::string& examples, std::string deviceHint)
    : Command(*new CLI::App(about, name), toRun_), deviceHint_(std::move(deviceHint)) {
  app_->footer(examples);
  std::string version;
  for (const uint32_t part : {kVersionMajor, kVersionMinor, kVersionPatch}) {
    version += (version.empty() ? " " : ".") + std::to_string(part);
  }
  app_->set_version_flag("--version", name + version + ", commit " + commit(), "Prints the version");
  app_->failure_message(inWords);
}

Program::~Program() {
  delete app_;
}

void Program::addDescriptions() {
  Command shell = add("completion", "Prints what a shell needs to complete this program's words", kCompletionExamples);
  auto which = std::make_shared<std::string>();
  shell.option("SHELL", which.get(), "bash or zsh; fish reads the manual page").required().oneOf({"bash", "zsh"});
  shell.run([app = app_, which] {
    const bool isZsh = *which == "zsh";
    if (isZsh) std::cout << "#compdef cyber-radar\nautoload -U +X bashcompinit && bashcompinit\n";
    std::cout << completion(*app);
    if (isZsh) std::cout << "_bash_complete -o default -F _cyber_radar\n";
    return 0;
  });
  add("man", "Prints the manual page: cyber-radar man | man -l -").run([app = app_] {
    std::cout << manual(*app);
    return 0;
  });
}

std::optional<int> Program::parse(int argc, char** argv, bool quiet) {
  try {
    app_->parse(argc, argv);
    return std::nullopt;
  } catch (const CLI::ParseError& error) {
    const bool isWrong = error.get_exit_code() != 0;
    if (!quiet) app_->exit(error);
    finishOutput();
    return isWrong ? kStatusBadInput : 0;
  }
}

int Program::main(int argc, char** argv) {
  std::string message;
  try {
    if (const std::optional<int> status = parse(argc, argv)) return *status;
    const int status = toRun_();
    finishOutput();
    return status;
  } catch (const Error& error) {
    message = error.what();
    for (const std::string& reason : error.reasons) message += "\n  " + reason;
    if (error.kind == Error::Kind::device) message += deviceHint_;
  } catch (const std::exception& error) {
    message = error.what();
  }
  std::cout.flush();
  std::cerr << app_->get_name() << ": " << message << "\n";
  return kStatusBadInput;
}

}  // namespace radar::tools
