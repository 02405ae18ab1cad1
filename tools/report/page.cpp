#include "report/page.h"

#include "report/colours.h"
#include "report/markup.h"

namespace radar::tools {

namespace {

constexpr const char* kStyle = R"(*{box-sizing:border-box}
body{margin:0;background:var(--page);color:var(--ink);font:16px/1.5 system-ui,sans-serif}
main{max-width:1200px;margin:0 auto;padding:24px 16px 48px}
h1{font-size:1.6rem;margin:0 0 4px}h2{font-size:1.15rem;margin:36px 0 8px}h3{font-size:1rem;margin:16px 0 4px}
p{margin:4px 0}.soft{color:var(--soft)}
.charts{display:grid;grid-template-columns:repeat(auto-fit,minmax(min(100%,500px),1fr));gap:16px}
.charts.large{grid-template-columns:1fr}
figure{margin:0;padding:12px;background:var(--panel);border-radius:8px}
figcaption{margin-bottom:8px;font-size:.85rem;color:var(--soft)}
svg{display:block;width:100%;height:auto}
.scroll{overflow-x:auto}.scroll svg{min-width:720px}
table{border-collapse:collapse;font-variant-numeric:tabular-nums;font-size:.92rem}
th,td{padding:3px 14px 3px 0;text-align:right;border-bottom:1px solid var(--grid);white-space:nowrap}
th:first-child,td:first-child{text-align:left}
.key span{display:inline-block;margin-right:18px}.key i{display:inline-block;width:12px;height:12px;margin-right:6px}
.findings li{margin:6px 0}code{overflow-wrap:anywhere}
.timeline{font:13px system-ui,"DejaVu Sans",sans-serif}.timeline text{fill:var(--ink)}.middle{text-anchor:middle}
.grid{stroke:var(--grid)}.bar{stroke:var(--panel);stroke-width:.6}
.bar.c0{fill:var(--c0)}.bar.c1{fill:var(--c1)}.bar.c2{fill:var(--c2)}.bar.c5{fill:var(--c5)}
)";

}  // namespace

std::string openPage(const std::string& title, const std::string& heading) {
  return "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
         "<meta name=\"viewport\" content=\"width=device-width,initial-scale=1\">\n<title>" +
         escaped(title) + "</title>\n<style>\n" + colourVariables() + kStyle + darkChartRules() + "</style>\n" +
         "</head>\n<body>\n<main>\n<h1>" + escaped(heading) + "</h1>\n";
}

std::string closePage() {
  return "</main>\n</body>\n</html>\n";
}

std::string figure(const std::string& svg, const std::vector<std::string>& notes) {
  std::string text = notes.empty() ? "<figure>" : "<figure><figcaption>";
  for (const std::string& note : notes) text += "<p>" + escaped(note) + "</p>";
  return text + (notes.empty() ? "\n" : "</figcaption>\n") + svg + "</figure>\n";
}

std::string openTable() {
  return "<div class=\"scroll\"><table>\n";
}

std::string row(const std::vector<std::string>& cells, const char* tag) {
  std::string text = "<tr>";
  for (const std::string& cell : cells) text += std::string("<") + tag + ">" + cell + "</" + tag + ">";
  return text + "</tr>\n";
}

std::string closeTable() {
  return "</table></div>\n";
}

}  // namespace radar::tools
