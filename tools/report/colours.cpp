#include "report/colours.h"

#include <array>
#include <string_view>

namespace radar::tools {

namespace {

struct Colour {
  std::string_view name, light, dark;
};

// Okabe and Ito's colours, which the colour-blind tell apart; the dark page takes their lighter ones first.
constexpr std::array kColours{
    Colour{"page", "#fff", "#14171b"},    Colour{"ink", "#1b1f24", "#e8eaed"},   Colour{"soft", "#5b6470", "#a2aab4"},
    Colour{"grid", "#e3e6ea", "#2c323a"}, Colour{"panel", "#f6f7f9", "#1c2026"}, Colour{"c0", "#0072b2", "#56b4e9"},
    Colour{"c1", "#d55e00", "#e69f00"},   Colour{"c2", "#009e73", "#2bc59a"},    Colour{"c3", "#cc79a7", "#cc79a7"},
    Colour{"c4", "#8a6d00", "#f0e442"},   Colour{"c5", "#56b4e9", "#7f9cff"},    Colour{"c6", "#1b1f24", "#e8eaed"},
    Colour{"c7", "#c98500", "#ff8a5c"}};
constexpr int kLineColours = 8;

std::string withColours(std::string rules, std::string_view Colour::*scheme) {
  for (const Colour& colour : kColours) {
    const std::string name = "var(--" + std::string(colour.name) + ")";
    for (size_t at = rules.find(name); at != std::string::npos; at = rules.find(name, at)) {
      rules.replace(at, name.size(), colour.*scheme);
    }
  }
  return rules;
}

}  // namespace

std::string chartRules() {
  std::string rules = R"(svg{font:13px system-ui,"DejaVu Sans",sans-serif}
svg text{fill:var(--ink)}.middle{text-anchor:middle}.end{text-anchor:end}.bold{font-weight:600}.small{font-size:11px}
.grid{stroke:var(--grid);fill:none}.line{fill:none;stroke-width:2.5}.thin{stroke-width:1.5}
.ideal{fill:none;stroke:var(--soft);stroke-dasharray:6 5}svg .soft{fill:var(--soft)}
.front{fill:none;stroke:var(--soft);stroke-width:7;stroke-opacity:.28;stroke-linejoin:round}
.band{fill:var(--c1);fill-opacity:.1}.hollow{fill:var(--panel);stroke-width:2}.cross{fill:none;stroke-width:1.5}
.bar{stroke:var(--panel);stroke-width:.6}
)";
  for (int i = 0; i < kLineColours; ++i) {
    const std::string c = "c" + std::to_string(i), t = "t" + std::to_string(i), value = "var(--" + c + ")";
    rules += "." + c + "{stroke:" + value + "}.mark." + c + ",.bar." + c + ",svg ." + t + "{fill:" + value + "}\n";
  }
  return rules;
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

std::string standaloneRules() {
  const std::string rules = chartRules() + ".paper{fill:var(--panel)}\n";
  return withColours(rules, &Colour::light) + "@media(prefers-color-scheme:dark){\n" +
         withColours(rules, &Colour::dark) + "}\n";
}

}  // namespace radar::tools
