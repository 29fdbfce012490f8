#include "viewer/report/language.h"

#include <algorithm>
#include <array>

namespace lightwell {
namespace {

constexpr std::array<const char*, language_count> language_codes = {"en", "de", "fr", "es"};

}  // namespace

std::optional<Language> language_of(std::string_view code) {
  const auto at = std::ranges::find(language_codes, code);
  if (at == language_codes.end()) return {};
  return static_cast<Language>(at - language_codes.begin());
}

const char* code_of(Language language) {
  return language_codes[static_cast<std::size_t>(language)];
}

char decimal_sign(Language language) {
  return language == Language::english ? '.' : ',';
}

std::string number_in(Language language, std::string number) {
  std::ranges::replace(number, '.', decimal_sign(language));
  return number;
}

}  // namespace lightwell
