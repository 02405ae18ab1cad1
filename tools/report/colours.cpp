#include "report/colours.h"

#include <algorithm>
#include <array>
#include <string>

#include "report/print.h"

namespace radar::tools {

namespace {

struct Colour {
  std::string_view name, light, dark;
};

// Okabe and Ito's colours, which the colour-blind tell apart; the dark page takes their lighter ones first.
constexpr std::array kColours{
    Colour{"page", "#ffffff", "#14171b"}, Colour{"ink", "#1b1f24", "#e8eaed"},   Colour{"soft", "#5b6470", "#a2aab4"},
    Colour{"grid", "#e3e6ea", "#2c323a"}, Colour{"panel", "#f6f7f9", "#1c2026"}, Colour{"c0", "#0072b2", "#56b4e9"},
    Colour{"c1", "#d55e00", "#e69f00"},   Colour{"c2", "#009e73", "#2bc59a"},    Colour{"c3", "#cc79a7", "#cc79a7"},
    Colour{"c4", "#8a6d00", "#f0e442"},   Colour{"c5", "#56b4e9", "#7f9cff"},    Colour{"c6", "#1b1f24", "#e8eaed"},
    Colour{"c7", "#c98500", "#ff8a5c"}};
// The ways in which gnuplot writes a colour.
std::array<std::string, 3> formsOf(std::string_view colour) {
  const unsigned long all = std::stoul(std::string(colour.substr(1)), nullptr, 16);
  const unsigned long red = all >> 16, green = all >> 8 & 255, blue = all & 255;
  return {std::string(colour), print("rgb(%lu,%lu,%lu)", red, green, blue),
          print("rgb(%3lu, %3lu, %3lu)", red, green, blue)};
}

}  // namespace

std::string_view lightColour(std::string_view name) {
  return std::find_if(kColours.begin(), kColours.end(), [&](const Colour& one) { return one.name == name; })->light;
}

std::string colourVariables() {
  std::string light = ":root{color-scheme:light dark", dark = "@media(prefers-color-scheme:dark){:root{";
  for (const Colour& colour : kColours) {
    const std::string name = "--" + std::string(colour.name) + ":";
    light += ";" + name + std::string(colour.light);
    dark += (dark.ends_with('{') ? "" : ";") + name + std::string(colour.dark);
  }
  return light + "}\n" + dark + "}}\n";
}

std::string darkChartRules() {
  std::string rules = "@media(prefers-color-scheme:dark){\n";
  for (const Colour& colour : kColours) {
    for (const char* property : {"fill", "stroke", "color"}) {
      std::string selectors;
      for (const std::string& form : formsOf(colour.light)) {
        selectors += print("%ssvg [%s=\"%s\"]", selectors.empty() ? "" : ",", property, form.c_str());
      }
      rules += selectors + print("{%s:%s}\n", property, std::string(colour.dark).c_str());
    }
  }
  return rules + "}\n";
}

}  // namespace radar::tools
