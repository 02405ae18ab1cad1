#include "report/page.h"

#include "report/chart.h"

namespace radar::tools {

namespace {

// Okabe and Ito's colours, which the colour-blind tell apart; the dark page takes their lighter ones first.
constexpr const char* kStyle = R"(<style>
:root{color-scheme:light dark;--page:#fff;--ink:#1b1f24;--soft:#5b6470;--grid:#e3e6ea;--panel:#f6f7f9;
--c0:#0072b2;--c1:#d55e00;--c2:#009e73;--c3:#cc79a7;--c4:#8a6d00;--c5:#56b4e9}
@media(prefers-color-scheme:dark){:root{--page:#14171b;--ink:#e8eaed;--soft:#a2aab4;--grid:#2c323a;--panel:#1c2026;
--c0:#56b4e9;--c1:#e69f00;--c2:#2bc59a;--c3:#cc79a7;--c4:#f0e442;--c5:#7f9cff}}
*{box-sizing:border-box}
body{margin:0;background:var(--page);color:var(--ink);font:16px/1.5 system-ui,sans-serif}
main{max-width:1200px;margin:0 auto;padding:24px 16px 48px}
h1{font-size:1.6rem;margin:0 0 4px}h2{font-size:1.15rem;margin:36px 0 8px}h3{font-size:1rem;margin:16px 0 4px}
p{margin:4px 0}.soft{color:var(--soft)}
.charts{display:grid;grid-template-columns:repeat(auto-fit,minmax(min(100%,350px),1fr));gap:16px}
figure{margin:0;padding:12px;background:var(--panel);border-radius:8px}
figcaption{font-weight:600;margin-bottom:8px}
svg{display:block;width:100%;height:auto;font:13px system-ui,sans-serif}
svg text{fill:var(--ink)}.middle{text-anchor:middle}.end{text-anchor:end}
.grid{stroke:var(--grid);fill:none}.line{fill:none;stroke-width:2.5}.ideal{fill:none;stroke:var(--soft);stroke-dasharray:6 5}
.c0{stroke:var(--c0)}.c1{stroke:var(--c1)}.c2{stroke:var(--c2)}.c3{stroke:var(--c3)}.c4{stroke:var(--c4)}.c5{stroke:var(--c5)}
.mark.c0,.bar.c0{fill:var(--c0)}.mark.c1,.bar.c1{fill:var(--c1)}.mark.c2,.bar.c2{fill:var(--c2)}
.mark.c3,.bar.c3{fill:var(--c3)}.mark.c4,.bar.c4{fill:var(--c4)}.mark.c5,.bar.c5{fill:var(--c5)}
.bar{stroke:var(--panel);stroke-width:.6}
.scroll{overflow-x:auto}.scroll svg{min-width:720px}
table{border-collapse:collapse;font-variant-numeric:tabular-nums;font-size:.92rem}
th,td{padding:3px 14px 3px 0;text-align:right;border-bottom:1px solid var(--grid);white-space:nowrap}
th:first-child,td:first-child{text-align:left}
.key span{display:inline-block;margin-right:18px}.key i{display:inline-block;width:12px;height:12px;margin-right:6px}
.findings li{margin:6px 0}code{overflow-wrap:anywhere}
</style>
)";

}  // namespace

std::string openPage(const std::string& title, const std::string& heading) {
  return "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
         "<meta name=\"viewport\" content=\"width=device-width,initial-scale=1\">\n<title>" +
         escaped(title) + "</title>\n" + kStyle + "</head>\n<body>\n<main>\n<h1>" + escaped(heading) + "</h1>\n";
}

std::string closePage() {
  return "</main>\n</body>\n</html>\n";
}

std::string figure(const std::string& caption, const std::string& svg) {
  return "<figure><figcaption>" + escaped(caption) + "</figcaption>\n" + svg + "</figure>\n";
}

std::string openTable() {
  return "<div class=\"scroll\"><table>\n";
}

std::string row(std::initializer_list<std::string> cells, const char* tag) {
  std::string text = "<tr>";
  for (const std::string& cell : cells) text += std::string("<") + tag + ">" + cell + "</" + tag + ">";
  return text + "</tr>\n";
}

std::string closeTable() {
  return "</table></div>\n";
}

}  // namespace radar::tools
