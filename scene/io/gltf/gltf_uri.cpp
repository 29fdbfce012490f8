#include "scene/io/gltf/gltf_uri.h"

#include <cctype>
#include <charconv>

namespace lightwell {
namespace {

int sextet(char c) {
  constexpr std::string_view alphabet =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  const std::size_t found = alphabet.find(c);
  return found == std::string_view::npos ? -1 : static_cast<int>(found);
}

}  // namespace

std::optional<std::string> decode_data_uri(std::string_view uri) {
  constexpr std::string_view mark = ";base64,";
  const std::size_t found = uri.find(mark);
  if (!uri.starts_with("data:") || found == std::string_view::npos) return std::nullopt;
  std::string_view text = uri.substr(found + mark.size());
  while (text.ends_with('=')) text.remove_suffix(1);
  std::string bytes;
  bytes.reserve(text.size() * 3 / 4);
  unsigned bits = 0;
  int count = 0;
  for (const char c : text) {
    const int value = sextet(c);
    if (value < 0) return std::nullopt;
    bits = bits << 6 | static_cast<unsigned>(value);
    if ((count += 6) < 8) continue;
    count -= 8;
    bytes += static_cast<char>(bits >> count & 0xffu);
  }
  return bytes;
}

bool is_absolute_uri(std::string_view uri) {
  if (uri.starts_with('/') || uri.starts_with('\\')) return true;
  // RFC 3986: a scheme is a letter, then letters, digits, +, - and . up to a colon.
  const std::size_t end =
      uri.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789+-.");
  const bool begins_with_letter = !uri.empty() && std::isalpha(static_cast<unsigned char>(uri[0]));
  return begins_with_letter && end != std::string_view::npos && uri[end] == ':';
}

std::string decode_percent(std::string_view text) {
  std::string result;
  for (std::size_t i = 0; i < text.size(); ++i) {
    unsigned code = 0;
    const char* const digits = text.data() + i + 1;
    if (text[i] == '%' && i + 2 < text.size() &&
        std::from_chars(digits, digits + 2, code, 16).ptr == digits + 2) {
      result += static_cast<char>(code);
      i += 2;
    } else {
      result += text[i];
    }
  }
  return result;
}

}  // namespace lightwell
