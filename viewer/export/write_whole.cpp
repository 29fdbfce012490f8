#include "viewer/export/write_whole.h"

#include <list>
#include <nlohmann/json.hpp>

#include "scene/atomic_file.h"

namespace lightwell {

namespace {

void write_temporary(AtomicStream& file, std::initializer_list<std::string_view> pieces) {
  for (const std::string_view piece : pieces) {
    file.stream().write(piece.data(), static_cast<std::streamsize>(piece.size()));
  }
  file.close();
}

}  // namespace

void write_whole(const std::filesystem::path& path,
                 std::initializer_list<std::string_view> pieces) {
  AtomicStream file(path);
  write_temporary(file, pieces);
  file.commit();
}

void write_together(std::initializer_list<FileText> files) {
  std::list<AtomicStream> written;
  for (const auto& [path, text] : files) write_temporary(written.emplace_back(path), {text});
  for (AtomicStream& file : written) file.commit();
}

std::string json_text(const nlohmann::ordered_json& json) {
  constexpr int indent = 2;
  return json.dump(indent, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

std::string one_line(std::string name) {
  for (char& c : name) {
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = '_';
  }
  return name;
}

}  // namespace lightwell
