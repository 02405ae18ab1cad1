#include "report/markup.h"

namespace radar::tools {

std::string escaped(std::string_view content) {
  std::string out;
  for (const char c : content) {
    if (c == '&') {
      out += "&amp;";
    } else if (c == '<') {
      out += "&lt;";
    } else if (c == '"') {
      out += "&quot;";
    } else {
      out += c;
    }
  }
  return out;
}

std::string openSvg(const std::string& attributes, const std::string& title) {
  return "<svg " + attributes + " role=\"img\" aria-label=\"" + escaped(title) + "\"><title>" + escaped(title) +
         "</title>\n";
}

}  // namespace radar::tools
