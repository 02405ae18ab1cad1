// The page's text before and after its data, made from page.html, style.css and the scripts.
#pragma once

namespace radar::tools {

extern const char *const kPageBefore, *const kPageAfter;

}  // namespace radar::tools
