#include "command/describe.h"

#include <functional>
#include <sstream>

namespace radar::tools {

namespace {

// A command, and the words that lead to it, each with a blank before it.
struct Entry {
  std::string path;
  const CLI::App* app;
};

void addEntries(std::vector<Entry>& entries, const std::string& path, const CLI::App& app) {
  entries.push_back({path, &app});
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) {
    addEntries(entries, path + " " + command->get_name(), *command);
  }
}

std::vector<Entry> entriesOf(const CLI::App& app) {
  std::vector<Entry> entries;
  addEntries(entries, "", app);
  return entries;
}

// What an option's value is: "N"; or all that it may be, if these are few: "sampled|contact|reference".
std::string valueOf(const CLI::Option& option) {
  constexpr size_t kMost = 60;
  const std::string type = option.get_type_name();
  return type.size() > kMost ? "WORD" : type;
}

// The words that an option's value may be; none where it is a number, a file or the like.
std::vector<std::string> choicesOf(const CLI::Option& option) {
  std::vector<std::string> words;
  const std::string type = option.get_type_name();
  if (type.find('|') == type.npos) return words;
  std::istringstream stream(type);
  for (std::string word; std::getline(stream, word, '|');) {
    if (word.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789-") == word.npos) words.push_back(word);
  }
  return words;
}

bool takesValue(const CLI::Option& option) {
  return option.get_items_expected_max() > 0;
}

// Calls use(option, "--name") for each.
void eachOption(const CLI::App& app, const std::function<void(const CLI::Option&, const std::string&)>& use) {
  for (const CLI::Option* option : app.get_options()) {
    for (const std::string& name : option->get_lnames()) use(*option, "--" + name);
  }
}

// The pattern of a case: every command, as the words that lead to it.
std::string patternOf(const std::vector<Entry>& entries) {
  std::vector<std::string> quoted;
  for (const Entry& entry : entries) {
    if (!entry.path.empty()) quoted.push_back("\"" + entry.path + "\"");
  }
  return joined(quoted, "|");
}

// What roff would take for its own: backslashes, hyphens that are no minus, and a dot or quote that a line begins with.
std::string roff(const std::string& text) {
  std::string lines;
  bool begins = true;
  for (const char c : text) {
    if (begins && (c == '.' || c == '\'')) lines += "\\&";
    lines += c == '\\' ? "\\e" : c == '-' ? "\\-" : std::string(1, c);
    begins = c == '\n';
  }
  return lines;
}

std::string synopsisOf(const Entry& entry) {
  std::string line = ".B cyber\\-radar" + roff(entry.path) + "\n";
  if (!commandNames(*entry.app).empty()) line += ".I COMMAND\n";
  for (const CLI::Option* option : entry.app->get_options()) {
    if (!option->get_positional()) continue;
    const std::string name = roff(option->get_name(true)) + (option->get_items_expected_max() > 1 ? "..." : "");
    line += option->get_required() ? ".I " + name + "\n" : ".RI [ " + name + " ]\n";
  }
  return line + ".RI [ OPTION ...]\n";
}

}  // namespace

std::vector<std::string> commandNames(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) {
    names.push_back(command->get_name());
  }
  return names;
}

std::string joined(const std::vector<std::string>& words, const char* between) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : between) + word;
  return text;
}

std::string completion(const CLI::App& app) {
  const std::vector<Entry> entries = entriesOf(app);
  std::string values, words;
  for (const Entry& entry : entries) {
    std::vector<std::string> names;
    eachOption(*entry.app, [&](const CLI::Option& option, const std::string& name) {
      names.push_back(name);
      const std::string choices = joined(choicesOf(option), " ");
      if (!choices.empty()) values += "    \"" + entry.path + " " + name + "\") words=\"" + choices + "\" ;;\n";
    });
    words += "      \"" + entry.path + "\") words=\"" + joined(commandNames(*entry.app), " ") +
             "\"\n        [[ $now == -* ]] && words=\"" + joined(names, " ") + "\" ;;\n";
  }
  return R"(# bash completion of cyber-radar
_cyber_radar() {
  local i at= words= now=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD-1]}
  [[ $before == = ]] && before=${COMP_WORDS[COMP_CWORD-2]}
  for ((i = 1; i < COMP_CWORD; ++i)); do
    case "$at ${COMP_WORDS[i]}" in )" +
         patternOf(entries) + R"() at+=" ${COMP_WORDS[i]}" ;; esac
  done
  case "$at $before" in
)" + values +
         R"(    *) case "$at" in
)" + words +
         R"(    esac ;;
  esac
  COMPREPLY=($(compgen -W "$words" -- "$now"))
}
complete -o default -F _cyber_radar cyber-radar
)";
}

std::string manual(const CLI::App& program) {
  const std::vector<Entry> entries = entriesOf(program);
  std::string page = ".TH CYBER\\-RADAR 1 \"\" \"Cyber Radar\" \"User Commands\"\n.SH NAME\ncyber\\-radar \\- " +
                     roff("distance to first contact of moving triangle meshes") + "\n.SH SYNOPSIS\n" +
                     synopsisOf(entries[0]) + ".SH DESCRIPTION\n" + roff(entries[0].app->get_description()) +
                     "\n.PP\n.nf\n" + roff(entries[0].app->get_footer()) + "\n.fi\n.SH COMMANDS\n";
  for (const Entry& entry : entries) {
    const auto& [path, app] = entry;
    if (!path.empty())
      page += ".SS" + roff(path) + "\n" + synopsisOf(entry) + ".PP\n" + roff(app->get_description()) + "\n";
    for (const CLI::Option* option : app->get_options()) {
      const std::string name = option->get_positional() ? option->get_name(true) : joined(option->get_lnames(), ", --");
      page += ".TP\n.B " + roff((option->get_positional() ? "" : "--") + name) + "\n";
      if (!option->get_positional() && takesValue(*option))
        page.insert(page.size() - 1, " \\fI" + roff(valueOf(*option)) + "\\fR");
      page += roff(option->get_description()) + "\n";
    }
    if (!path.empty() && app->get_footer() != app->get_parent()->get_footer() && !app->get_footer().empty()) {
      page += ".PP\n.nf\n" + roff(app->get_footer()) + "\n.fi\n";
    }
  }
  return page;
}

}  // namespace radar::tools
