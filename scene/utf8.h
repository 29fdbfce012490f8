#pragma once

#include <string>
#include <string_view>

namespace lightwell {

/// Converts 8-bit text to UTF-8. Bytes that are not valid UTF-8 are taken as Latin-1; control
/// characters are left out. The result may stand in XML and JSON.
std::string as_utf8(std::string_view text);

/// as_utf8() without the control characters U+0080 to U+009F either, which terminals obey.
std::string plain_text(std::string_view text);

}  // namespace lightwell
