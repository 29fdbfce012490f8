#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace lightwell {

/// Bytes of "data:TYPE;base64,..." (RFC 2397, RFC 4648); empty if `uri` is no such URI.
std::optional<std::string> decode_data_uri(std::string_view uri);

/// Decodes percent escapes (RFC 3986): "my%20room.bin" becomes "my room.bin". Malformed escapes are
/// kept.
std::string decode_percent(std::string_view text);

/// True for a URI with a scheme ("file:", "https:") or a path from a root, which glTF 2.0 (3.6.1.1)
/// keeps for data alone.
bool is_absolute_uri(std::string_view uri);

}  // namespace lightwell
