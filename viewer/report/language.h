#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace lightwell {

/// Language of a report that people read. JSON and CSV are the same in all.
enum class Language { english, german, french, spanish };
inline constexpr int language_count = 4;

/// The language of a code of ISO 639-1: "en", "de", "fr" or "es"; empty: another.
std::optional<Language> language_of(std::string_view code);
const char* code_of(Language language);

/// The decimal sign of numbers: '.' or ','.
char decimal_sign(Language language);
/// A number as printed by fmt, with the decimal sign of the language.
std::string number_in(Language language, std::string number);

}  // namespace lightwell
