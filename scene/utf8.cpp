#include "scene/utf8.h"

#include <cstdint>

namespace lightwell {
namespace {

// Length in bytes of the UTF-8 character at `at` (RFC 3629); 0 if there is none: neither overlong
// forms nor surrogates are characters, and XML has no U+FFFE and U+FFFF.
std::size_t utf8_length(std::string_view text, std::size_t at) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned char lead = byte(at);
  const std::size_t length = lead < 0x80u                     ? 1
                             : lead >= 0xc2u && lead < 0xe0u  ? 2
                             : lead >= 0xe0u && lead < 0xf0u  ? 3
                             : lead >= 0xf0u && lead <= 0xf4u ? 4
                                                              : 0;
  if (length == 0 || at + length > text.size()) return 0;
  if (length == 1) return 1;
  std::uint32_t code = lead & (0x7fu >> length);
  for (std::size_t i = 1; i < length; ++i) {
    if ((byte(at + i) & 0xc0u) != 0x80u) return 0;
    code = code << 6u | (byte(at + i) & 0x3fu);
  }
  constexpr std::uint32_t shortest[] = {0, 0, 0x80, 0x800, 0x10000};
  const bool is_surrogate = code >= 0xd800u && code < 0xe000u;
  const bool is_no_character = code == 0xfffeu || code == 0xffffu || code > 0x10ffffu;
  return code < shortest[length] || is_surrogate || is_no_character ? 0 : length;
}

}  // namespace

std::string as_utf8(std::string_view text) {
  std::string result;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t length = utf8_length(text, at);
    const auto byte = static_cast<unsigned char>(text[at]);
    if (length > 0) {
      if (byte >= 0x20u && byte != 0x7fu) result += text.substr(at, length);
      at += length;
      continue;
    }
    result += static_cast<char>(0xc0u | (byte >> 6u));
    result += static_cast<char>(0x80u | (byte & 0x3fu));
    ++at;
  }
  return result;
}

std::string plain_text(std::string_view text) {
  const std::string all = as_utf8(text);
  std::string plain;
  for (std::size_t at = 0; at < all.size(); ++at) {
    const bool is_control = all[at] == '\xc2' && static_cast<unsigned char>(all[at + 1]) < 0xa0u;
    at += is_control ? 1 : 0;
    if (!is_control) plain += all[at];
  }
  return plain;
}

}  // namespace lightwell
