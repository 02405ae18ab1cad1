#include "cyber_radar/command_line.h"

#include <algorithm>
#include <numeric>
#include <sstream>

#include "commit/commit.h"
#include "import/input_error.h"
#include "radar/radar.h"

namespace radar::tools {

namespace {

// How many letters are to be added, left out, replaced, or swapped with the next, to make one word of the other (the
// optimal string alignment distance).
size_t editsBetween(std::string_view a, std::string_view b) {
  std::vector<std::vector<size_t>> edits(a.size() + 1, std::vector<size_t>(b.size() + 1));
  std::iota(edits[0].begin(), edits[0].end(), size_t{0});
  for (size_t i = 1; i <= a.size(); ++i) {
    edits[i][0] = i;
    for (size_t k = 1; k <= b.size(); ++k) {
      edits[i][k] = std::min({edits[i - 1][k] + 1, edits[i][k - 1] + 1, edits[i - 1][k - 1] + (a[i - 1] != b[k - 1])});
      const bool isSwap = i > 1 && k > 1 && a[i - 1] == b[k - 2] && a[i - 2] == b[k - 1];
      if (isSwap) edits[i][k] = std::min(edits[i][k], edits[i - 2][k - 2] + 1);
    }
  }
  return edits.back().back();
}

// ", did you mean ...?", if some word is near.
std::string nearest(std::string_view word, const std::vector<std::string>& known) {
  const std::string* best = nullptr;
  size_t least = std::max<size_t>(1, word.size() / 3) + 1;
  for (const std::string& one : known) {
    const size_t edits = one.starts_with(word) ? 0 : editsBetween(word, one);
    if (edits >= least) continue;
    least = edits;
    best = &one;
  }
  return best == nullptr ? "" : "; did you mean " + *best + "?";
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
  if (app.get_require_subcommand_min() > 0) return "expected a command, " + quoted + nearest(word, commandsOf(app));
  std::string all = word;
  for (size_t i = 1; i < unread.size(); ++i) all += " " + unread[i];
  return "expected nothing more, got \"" + printable(all, 60) + "\"";
}

// "one|two" in the name of a type, which may be written so or end in ":{one,two}"; else nothing.
std::string listIn(const std::string& type) {
  const size_t brace = type.find(":{");
  if (brace == type.npos) return type.find('|') == type.npos ? "" : type;
  std::string list = type.substr(brace + 2, type.find('}') - brace - 2);
  std::replace(list.begin(), list.end(), ',', '|');
  return list;
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

}  // namespace

std::vector<std::string> commandsOf(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) {
    names.push_back(command->get_name());
  }
  return names;
}

std::string valueOf(const CLI::Option& option) {
  constexpr size_t kMost = 60;
  const std::string type = option.get_type_name(), choices = listIn(type);
  return choices.empty() || choices.size() > kMost ? type.substr(0, type.find(':')) : choices;
}

std::vector<std::string> choicesOf(const CLI::Option& option) {
  std::vector<std::string> words;
  std::istringstream stream(listIn(option.get_type_name()));
  for (std::string word; std::getline(stream, word, '|');) {
    if (word.find_first_not_of("abcdefghijklmnopqrstuvwxyz-") == word.npos) words.push_back(word);
  }
  return words;
}

void addBasics(CLI::App& app) {
  std::string version;
  for (const uint32_t part : {kVersionMajor, kVersionMinor, kVersionPatch}) {
    version += (version.empty() ? " " : ".") + std::to_string(part);
  }
  app.set_version_flag("--version", app.get_name() + version + ", commit " + commit(), "Prints the version");
  app.failure_message(inWords);
}

}  // namespace radar::tools
