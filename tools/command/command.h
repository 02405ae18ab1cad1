// The command line of a program: its commands, their options, and what each runs. Only this room knows CLI11.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace radar::tools {

/// Where an option's value goes; it must live as long as the program's command line.
using OptionTarget = std::variant<bool*, std::string*, std::optional<std::string>*, double*, std::optional<double>*,
                                  uint32_t*, std::optional<uint32_t>*, uint64_t*, std::vector<std::string>*,
                                  std::vector<uint32_t>*, std::vector<double>*, std::function<void(double)>,
                                  std::function<void(const std::string&)>, std::function<void()>>;

/// An option, or an argument without a name; the calls say more of it.
class Option {
 public:
  explicit Option(CLI::Option& option) : option_(&option) {}

  Option required();
  /// How the help calls its value: "N", "FILE.json".
  Option value(const std::string& name);
  /// Only these words, which the help and the shells' completions list unless value() says otherwise.
  Option oneOf(const std::vector<std::string>& words);
  /// Only numbers in this range.
  Option within(double least, double most);
  /// A list with commas between.
  Option list();
  /// So many values, each of its own: --at 0 0 1.
  Option count(int least, int most);
  Option count(int exactly);

  bool given() const;

 private:
  CLI::Option* option_;
};

/// A command: it has options and something to run, or commands of its own.
class Command {
 public:
  Command(CLI::App& app, std::function<int()>& chosen) : app_(&app), chosen_(&chosen) {}

  /// A command of this one. `examples` stand below its help.
  Command add(const std::string& name, const std::string& about, const std::string& examples = "");
  /// `name` with two hyphens is an option, or a flag where `target` is a bool or a function without an argument;
  /// without them an argument. A default that is not empty is shown in the help.
  Option option(const std::string& name, OptionTarget target, const std::string& about);
  /// What the command does; it returns the exit status.
  void run(std::function<int()> run);

 protected:
  CLI::App* app_;
  std::function<int()>* chosen_;  ///< what the command line asks for
};

/// A program with a command line.
class Program : public Command {
 public:
  /// `deviceHint` follows a message that no device can be used.
  Program(const std::string& name, const std::string& about, const std::string& examples = "",
          std::string deviceHint = "");
  ~Program();
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;

  /// `completion`, for bash and zsh, and `man`: they describe all commands.
  void addDescriptions();

  /// Reads the command line. Returns the exit status if the program ends here: the help or version was asked for, or
  /// something is wrong, which it says unless `quiet`. Throws what an option's function throws.
  std::optional<int> parse(int argc, char** argv, bool quiet = false);
  /// Parses, runs what was chosen and returns the exit status; says on standard error what was thrown.
  int main(int argc, char** argv);

 private:
  std::string deviceHint_;
  std::function<int()> toRun_;
};

}  // namespace radar::tools
