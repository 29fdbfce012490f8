#include "radiosity/solution/compressed_blocks.h"

#include <zlib.h>

#include <algorithm>
#include <atomic>
#include <bit>
#include <cstring>
#include <limits>
#include <new>
#include <numeric>
#include <utility>

#include "scene/parallel.h"

namespace lightwell {
namespace {

static_assert(std::endian::native == std::endian::little,
              "files are written and read on little-endian machines alone");

constexpr std::uint64_t word = sizeof(std::uint64_t);
constexpr std::ptrdiff_t before_sizes = 3;  // words of a head
constexpr std::size_t block_size = 32768;   // VTK's own
constexpr int blocks_at_once = 4;           // of one thread

void add_words(std::string& text, std::span<const std::uint64_t> words) {
  const std::size_t end = text.size();
  text.resize(end + words.size_bytes());
  std::memcpy(text.data() + end, words.data(), words.size_bytes());
}

std::string compressed(std::span<const char> bytes) {
  uLongf length = compressBound(static_cast<uLong>(bytes.size()));
  std::string packed(length, '\0');
  // The room suffices, so that zlib fails for want of memory alone.
  if (compress2(reinterpret_cast<Bytef*>(packed.data()), &length,
                reinterpret_cast<const Bytef*>(bytes.data()), static_cast<uLong>(bytes.size()),
                Z_DEFAULT_COMPRESSION) != Z_OK) {
    throw std::bad_alloc();
  }
  packed.resize(length);
  packed.shrink_to_fit();
  return packed;
}

}  // namespace

std::string compressed_blocks(std::span<const char> bytes) {
  const std::size_t count = (bytes.size() + block_size - 1) / block_size;
  std::vector<std::string> blocks(count);
  parallel_for(static_cast<int>(count), blocks_at_once, [&](int begin, int end) {
    for (int b = begin; b < end; ++b) {
      const std::size_t from = block_size * static_cast<std::size_t>(b);
      blocks[static_cast<std::size_t>(b)] =
          compressed(bytes.subspan(from, std::min(block_size, bytes.size() - from)));
    }
  });
  std::vector<std::uint64_t> head{count, block_size, bytes.size() % block_size};
  for (const std::string& block : blocks) head.push_back(block.size());
  std::string text;
  text.reserve(std::accumulate(head.begin() + before_sizes, head.end(), word * head.size()));
  add_words(text, head);
  for (std::string& block : blocks) text += std::exchange(block, {});
  return text;
}

std::uint64_t BlockHead::compressed_bytes() const {
  return std::accumulate(compressed.begin(), compressed.end(), std::uint64_t{0});
}

// No sum overflows: a file has less than 2^53 bytes, and each makes at most 1032.
std::uint64_t BlockHead::bytes() const {
  return compressed.empty() ? 0 : (compressed.size() - 1) * size + last;
}

BlockHead block_head(
    std::uint64_t left,
    const std::function<std::vector<std::uint64_t>(std::uint64_t, std::uint64_t)>& read,
    const std::function<void(const std::string&)>& reject) {
  constexpr std::uint64_t most = std::numeric_limits<int>::max();
  if (left < word) reject("the offset is too large");
  const std::uint64_t count = read(0, 1).front();
  if (count == 0) return {};
  if (count > most || left / word < before_sizes || count > left / word - before_sizes) {
    reject("there are more blocks than the file has room for");
  }
  std::vector<std::uint64_t> words = read(0, before_sizes + count);
  left -= word * words.size();
  BlockHead head{.size = words[1], .last = words[2] == 0 ? words[1] : words[2]};
  if (head.size == 0 || head.last > head.size) reject("the size of a block is wrong");
  head.compressed.assign(words.begin() + before_sizes, words.end());
  for (std::uint64_t b = 0; b < count; ++b) {
    // Deflate makes at most 1032 bytes of one (Deutsch 1996: 258 bytes from two bits).
    constexpr std::uint64_t most_of_one = 1032;
    const std::uint64_t whole = b + 1 == count ? head.last : head.size;
    const std::uint64_t packed = head.compressed[b];
    if (packed == 0 || packed > left || whole / most_of_one > packed) {
      reject("a block is longer than the file");
    }
    left -= packed;
  }
  return head;
}

bool uncompress_blocks(const BlockHead& head, std::span<const char> blocks, std::span<char> bytes) {
  const std::size_t count = head.compressed.size();
  std::vector<std::uint64_t> begin(count + 1, 0);
  std::partial_sum(head.compressed.begin(), head.compressed.end(), begin.begin() + 1);
  std::atomic<bool> is_whole = true;
  parallel_for(static_cast<int>(count), blocks_at_once, [&](int first, int end) {
    for (auto b = static_cast<std::size_t>(first); b < static_cast<std::size_t>(end); ++b) {
      const std::uint64_t whole = b + 1 == count ? head.last : head.size;
      uLongf length = whole;
      const int result =
          uncompress(reinterpret_cast<Bytef*>(bytes.data() + b * head.size), &length,
                     reinterpret_cast<const Bytef*>(blocks.data() + begin[b]), head.compressed[b]);
      if (result != Z_OK || length != whole) is_whole = false;
    }
  });
  return is_whole;
}

}  // namespace lightwell
