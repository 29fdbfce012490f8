#include "viewer/export/write_whole.h"

#include <fmt/format.h>

#include <cerrno>
#include <fstream>
#include <list>
#include <stdexcept>
#include <system_error>

#include "scene/atomic_file.h"

namespace lightwell {

namespace {

void write_temporary(const AtomicFile& file, const std::filesystem::path& path,
                     std::initializer_list<std::string_view> pieces) {
  errno = 0;
  std::ofstream stream(file.temporary(), std::ios::binary);
  for (const std::string_view piece : pieces) {
    stream.write(piece.data(), static_cast<std::streamsize>(piece.size()));
  }
  stream.close();
  if (!stream) {
    throw std::runtime_error(fmt::format(
        "{}: cannot be written: {}", path.string(),
        errno != 0 ? std::generic_category().message(errno) : std::string("the disk may be full")));
  }
}

}  // namespace

void write_whole(const std::filesystem::path& path,
                 std::initializer_list<std::string_view> pieces) {
  AtomicFile file(path);
  write_temporary(file, path, pieces);
  file.commit();
}

void write_together(std::initializer_list<FileText> files) {
  std::list<AtomicFile> written;
  for (const auto& [path, text] : files) {
    write_temporary(written.emplace_back(path), path, {text});
  }
  for (AtomicFile& file : written) file.commit();
}

std::string one_line(std::string name) {
  for (char& c : name) {
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = '_';
  }
  return name;
}

}  // namespace lightwell
