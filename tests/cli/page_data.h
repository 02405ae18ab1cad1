#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace radar::test {

/// What a page of answers shows: the JSON in it.
inline nlohmann::json pageData(const std::string& page) {
  const std::string begin = "<script type=\"application/json\" id=\"data\">";
  const size_t at = page.find(begin) + begin.size();
  return nlohmann::json::parse(page.substr(at, page.find("</script>", at) - at));
}

}  // namespace radar::test
