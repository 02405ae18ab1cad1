// A page of charts and tables that needs nothing beside itself: light or dark, as its reader's screen is.
#pragma once

#include <string>
#include <vector>

namespace radar::tools {

/// The page from its doctype to its <h1>, and its end.
std::string openPage(const std::string& title, const std::string& heading);
std::string closePage();

/// A chart under what is to be said of it. `svg` is markup, the others are text.
std::string figure(const std::string& svg, const std::vector<std::string>& notes = {});

/// A table that scrolls by itself where it is too wide: openTable(), rows, closeTable(). Cells are markup.
std::string openTable();
std::string row(const std::vector<std::string>& cells, const char* tag = "td");
std::string closeTable();

}  // namespace radar::tools
