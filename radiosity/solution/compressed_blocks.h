#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace lightwell {

/// Bytes compressed by zlib in blocks, as VTK's XML files hold each array: little-endian words of
/// 64 bits (the number of blocks, the bytes of a block, those of the last block or 0 if it is as
/// long as the others, the compressed bytes of each block), then the blocks. (VTK File Formats,
/// "XML file formats", compressed data.) The text is the same on any number of threads.
std::string compressed_blocks(std::span<const char> bytes);

/// The head of compressed blocks.
struct BlockHead {
  std::vector<std::uint64_t> compressed{};  ///< bytes of each block
  std::uint64_t size = 0;                   ///< bytes of a block but the last, uncompressed
  std::uint64_t last = 0;                   ///< bytes of the last block, uncompressed

  std::uint64_t compressed_bytes() const;
  /// Bytes of all blocks, uncompressed.
  std::uint64_t bytes() const;
};

/// Reads a head at the beginning of `left` bytes by read(place, count), which returns `count` words
/// from the byte `place` on. Throws what reject(reason) throws if the blocks do not fit into `left`
/// bytes, or uncompressed bytes are more than zlib can make of them; takes no more memory than the
/// head has bytes.
BlockHead block_head(
    std::uint64_t left,
    const std::function<std::vector<std::uint64_t>(std::uint64_t place, std::uint64_t count)>& read,
    const std::function<void(const std::string& reason)>& reject);

/// Uncompresses blocks into `bytes`, as many as head.bytes(). Returns false if a block is damaged.
/// Precondition: `blocks` has head.compressed_bytes() bytes.
bool uncompress_blocks(const BlockHead& head, std::span<const char> blocks, std::span<char> bytes);

}  // namespace lightwell
