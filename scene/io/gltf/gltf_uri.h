#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace lightwell {

/// The bytes of "data:TYPE;base64,..." (RFC 2397, RFC 4648); empty if it is no such thing.
std::optional<std::string> decode_data_uri(std::string_view uri);

/// "my%20room.bin" is "my room.bin" (RFC 3986); what is no %XX stays as it is.
std::string decode_percent(std::string_view text);

}  // namespace lightwell
