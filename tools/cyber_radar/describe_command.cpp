// What shells and manuals want to know, from the options themselves.
#include <functional>
#include <iostream>

#include "cyber_radar/command_line.h"
#include "cyber_radar/commands.h"

namespace radar::tools {

namespace {

constexpr const char* kCompletionExamples = R"(Examples:
  source <(cyber-radar completion bash)      in ~/.bashrc, unless an installation brought it
  cyber-radar completion zsh > ~/.zfunc/_cyber-radar
  cyber-radar completion fish > ~/.config/fish/completions/cyber-radar.fish)";

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

std::string joined(const std::vector<std::string>& words, const char* between) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : between) + word;
  return text;
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

std::string escaped(const std::string& text, std::string_view special, const std::string& escape) {
  std::string result;
  for (const char c : text) result += special.find(c) == special.npos ? std::string(1, c) : escape + c;
  return result;
}

// The pattern of a case: every command, as the words that lead to it.
std::string patternOf(const std::vector<Entry>& entries) {
  std::vector<std::string> quoted;
  for (const Entry& entry : entries) {
    if (!entry.path.empty()) quoted.push_back("\"" + entry.path + "\"");
  }
  return joined(quoted, "|");
}

std::string forBash(const std::vector<Entry>& entries) {
  std::string values, words;
  for (const Entry& entry : entries) {
    std::vector<std::string> names;
    eachOption(*entry.app, [&](const CLI::Option& option, const std::string& name) {
      names.push_back(name);
      const std::string choices = joined(choicesOf(option), " ");
      if (!choices.empty()) values += "    \"" + entry.path + " " + name + "\") words=\"" + choices + "\" ;;\n";
    });
    words += "      \"" + entry.path + "\") words=\"" + joined(commandsOf(*entry.app), " ") +
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

std::string forZsh(const std::vector<Entry>& entries) {
  const auto text = [](const std::string& about) { return escaped(escaped(about, "[]:\\", "\\"), "'", "'\\'"); };
  std::string cases;
  for (const auto& [path, app] : entries) {
    cases += "    (\"" + path + "\") _arguments";
    eachOption(*app, [&](const CLI::Option& option, const std::string& name) {
      const std::string choices = joined(choicesOf(option), " ");
      cases += " \\\n      '" + name + "[" + text(option.get_description()) + "]";
      if (takesValue(option))
        cases += ":" + text(valueOf(option)) + ":" + (choices.empty() ? "_files" : "(" + choices + ")");
      cases += "'";
    });
    if (commandsOf(*app).empty()) {
      cases += " \\\n      '*:file:_files' ;;\n";
      continue;
    }
    cases += " \\\n      '1:command:((";
    for (const CLI::App* command : app->get_subcommands([](const CLI::App*) { return true; })) {
      cases += command->get_name() + "\\:\"" + escaped(text(command->get_description()), "\"$`", "\\") + "\" ";
    }
    cases += "))' ;;\n";
  }
  return "#compdef cyber-radar\nlocal at=\nwhile ((CURRENT > 2)); do\n  case \"$at $words[2]\" in (" +
         patternOf(entries) +
         ") at+=\" $words[2]\"; shift words; ((--CURRENT)) ;; (*) break ;; esac\ndone\ncase \"$at\" in\n" + cases +
         "esac\n";
}

std::string forFish(const std::vector<Entry>& entries) {
  const auto quoted = [](const std::string& about) { return "'" + escaped(about, "'\\", "\\") + "'"; };
  std::string lines = "# fish completion of cyber-radar\n";
  for (const auto& [path, app] : entries) {
    const std::string name = path.substr(path.rfind(' ') + 1);
    const std::string begin =
        "complete -c cyber-radar -n '" +
        (path.empty() ? std::string("__fish_use_subcommand") : "__fish_seen_subcommand_from " + name) + "' ";
    for (const CLI::App* command : app->get_subcommands([](const CLI::App*) { return true; })) {
      lines += begin + "-f -a " + command->get_name() + " -d " + quoted(command->get_description()) + "\n";
    }
    eachOption(*app, [&](const CLI::Option& option, const std::string& option_name) {
      const std::string choices = joined(choicesOf(option), " ");
      lines += begin + "-l " + option_name.substr(2) + " -d " + quoted(option.get_description());
      if (takesValue(option)) lines += choices.empty() ? " -r" : " -x -a '" + choices + "'";
      lines += "\n";
    });
  }
  return lines;
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
  if (!commandsOf(*entry.app).empty()) line += ".I COMMAND\n";
  for (const CLI::Option* option : entry.app->get_options()) {
    if (!option->get_positional()) continue;
    const std::string name = roff(option->get_name(true)) + (option->get_items_expected_max() > 1 ? "..." : "");
    line += option->get_required() ? ".I " + name + "\n" : ".RI [ " + name + " ]\n";
  }
  return line + ".RI [ OPTION ...]\n";
}

std::string manual(const std::vector<Entry>& entries) {
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

}  // namespace

void addDescribeCommands(CLI::App& app) {
  CLI::App* completion = app.add_subcommand("completion", "Prints what a shell needs to complete this program's words");
  completion->footer(kCompletionExamples);
  auto shell = std::make_shared<std::string>();
  completion->add_option("SHELL", *shell, "bash, zsh or fish")
      ->required()
      ->check(CLI::IsMember({"bash", "zsh", "fish"}));
  completion->callback([&app, shell] {
    const std::vector<Entry> entries = entriesOf(app);
    std::cout << (*shell == "bash" ? forBash(entries) : *shell == "zsh" ? forZsh(entries) : forFish(entries));
  });
  CLI::App* man = app.add_subcommand("man", "Prints the manual page: cyber-radar man | man -l -");
  man->footer("");
  man->callback([&app] { std::cout << manual(entriesOf(app)); });
}

}  // namespace radar::tools
