#include "tests/fuzz/mutation.h"

#include <zlib.h>

namespace lightwell::fuzz {

std::optional<std::string> inflated(std::string_view stream) {
  std::string contents(longest_contents, '\0');
  z_stream from{};
  from.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(stream.data()));  // is only read
  from.avail_in = static_cast<uInt>(stream.size());
  from.next_out = reinterpret_cast<Bytef*>(contents.data());
  from.avail_out = static_cast<uInt>(contents.size());
  if (inflateInit(&from) != Z_OK) return std::nullopt;
  const int state = inflate(&from, Z_FINISH);
  contents.resize(from.total_out);
  inflateEnd(&from);
  if (state != Z_STREAM_END) return std::nullopt;
  return contents;
}

std::string deflated(std::string_view contents) {
  uLongf size = compressBound(static_cast<uLong>(contents.size()));
  std::string stream(size, '\0');
  compress(reinterpret_cast<Bytef*>(stream.data()), &size,
           reinterpret_cast<const Bytef*>(contents.data()), static_cast<uLong>(contents.size()));
  stream.resize(size);
  return stream;
}

}  // namespace lightwell::fuzz
