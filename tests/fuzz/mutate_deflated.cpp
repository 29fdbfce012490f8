// Changes of files whose contents zlib has packed: PNG pictures and Mitsuba's serialized meshes.
#include <zlib.h>

#include <algorithm>
#include <vector>

#include "tests/fuzz/mutation.h"
#include "tests/fuzz/target.h"

namespace lightwell::fuzz {
namespace {

constexpr std::size_t png_signature = 8, chunk_frame = 12;  // length, type and CRC of a chunk

std::uint32_t big_endian_at(std::string_view bytes, std::size_t at) {
  std::uint32_t number = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    number = number << 8U | static_cast<unsigned char>(bytes[at + i]);
  }
  return number;
}

std::string big_endian(std::uint32_t number) {
  std::string bytes;
  for (int shift = 24; shift >= 0; shift -= 8) bytes += static_cast<char>(number >> shift & 0xffU);
  return bytes;
}

std::string png_chunk(const std::string& type, const std::string& data) {
  const std::string guarded = type + data;
  const uLong crc =
      crc32(0, reinterpret_cast<const Bytef*>(guarded.data()), static_cast<uInt>(guarded.size()));
  return big_endian(static_cast<std::uint32_t>(data.size())) + guarded +
         big_endian(static_cast<std::uint32_t>(crc));
}

}  // namespace

// One chunk is changed, of pixels (IDAT) mostly their contents, and every chunk gets its CRC.
std::string mutate_png(const std::string& file, const ByteMutator& mutate_bytes,
                       std::uint64_t seed) {
  Choice choice(seed);
  if (choice.is_one_of(8) || file.size() < png_signature) {
    return mutate_bytes(file, longest_contents);
  }
  struct Chunk {
    std::string type, data;
  };
  std::vector<Chunk> chunks;
  for (std::size_t at = png_signature; at + chunk_frame <= file.size();) {
    const std::size_t length =
        std::min<std::size_t>(big_endian_at(file, at), file.size() - at - chunk_frame);
    chunks.push_back({file.substr(at + 4, 4), file.substr(at + 8, length)});
    at += chunk_frame + length;
  }
  if (chunks.empty()) return mutate_bytes(file, longest_contents);
  const std::size_t chosen = choice.below(chunks.size());
  Chunk& chunk = chunks[chosen];
  switch (choice.below(8)) {
    case 0:
      chunk.type = mutate_bytes(chunk.type, 4);
      chunk.type.resize(4, 'a');
      break;
    case 1:
      chunks.insert(chunks.begin() + static_cast<std::ptrdiff_t>(chosen), Chunk(chunk));
      break;
    case 2:
      std::swap(chunk, chunks[choice.below(chunks.size())]);
      break;
    default: {
      const auto contents = chunk.type == "IDAT" ? inflated(chunk.data) : std::nullopt;
      chunk.data = contents ? deflated(mutate_bytes(*contents, longest_contents))
                            : mutate_bytes(chunk.data, longest_contents);
    }
  }
  std::string changed = file.substr(0, png_signature);
  for (const Chunk& each : chunks) changed += png_chunk(each.type, each.data);
  return changed;
}

// The contents of the first mesh are changed. Meshes behind it and their table go.
std::string mutate_serialized(const std::string& file, const ByteMutator& mutate_bytes,
                              std::uint64_t seed) {
  constexpr std::size_t head = 4;  // magic and version
  Choice choice(seed);
  const auto contents =
      file.size() < head || choice.is_one_of(8) ? std::nullopt : inflated(file.substr(head));
  if (!contents) return mutate_bytes(file, longest_contents);
  return file.substr(0, head) + deflated(mutate_bytes(*contents, longest_contents));
}

}  // namespace lightwell::fuzz
