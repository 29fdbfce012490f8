#include "scene/io/comma_fields.h"

#include "scene/io/text_file.h"

namespace lightwell {

std::vector<std::string_view> comma_fields(std::string_view line) {
  std::vector<std::string_view> fields;
  for (std::size_t begin = 0;;) {
    const std::size_t first = line.find_first_not_of(" \t", begin);
    const std::size_t quote = first != std::string_view::npos && line[first] == '"'
                                  ? line.find('"', first + 1)
                                  : std::string_view::npos;
    const bool is_quoted = quote != std::string_view::npos;
    const std::size_t comma = line.find(',', is_quoted ? quote : begin);
    fields.push_back(is_quoted ? line.substr(first + 1, quote - first - 1)
                               : trimmed(line.substr(begin, comma - begin)));
    if (comma == std::string_view::npos) return fields;
    begin = comma + 1;
  }
}

std::string quoted_field(std::string name) {
  for (std::size_t at = 0; (at = name.find('"', at)) != std::string::npos; at += 2) {
    name.insert(at, 1, '"');
  }
  if (name.find_first_of("=+-@") == 0) name.insert(0, 1, '\'');
  return '"' + name + '"';
}

}  // namespace lightwell
