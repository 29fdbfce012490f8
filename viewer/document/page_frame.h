#pragma once

#include <string>
#include <vector>

namespace lightwell {

/// The beginning of a page for screens and A4 paper, up to <body>, with the style of tables, plans
/// and curves. `language` is that of the text, BCP 47.
std::string page_begin(const std::string& title, const char* language = "en");
/// Style sheet of plans and curves, whose units are millimetres, with letters of a family of fonts.
std::string drawing_style(const std::string& family);
/// A heading and a list of sentences; empty without sentences.
std::string list_section(const char* title, const std::vector<std::string>& sentences);
inline constexpr const char* page_end = "</body></html>\n";

}  // namespace lightwell
