// The fuzzer: libFuzzer's entry points for the target named by --target=NAME. One program has all
// targets, since linking it takes as long as one target's program would.
//   lightwell_fuzz --targets                       prints names and folders of sources
//   lightwell_fuzz --target=NAME [libFuzzer's options] [folders or files]
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <string_view>

#include "scene/errors.h"
#include "tests/fuzz/target.h"

// libFuzzer's own mutations.
extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t longest);

namespace {

using lightwell::fuzz::Target;

const Target* chosen = nullptr;

std::string mutate_bytes(std::string bytes, std::size_t longest) {
  const std::size_t size = std::min(bytes.size(), longest);
  bytes.resize(std::max<std::size_t>(longest, 1));
  bytes.resize(LLVMFuzzerMutate(reinterpret_cast<std::uint8_t*>(bytes.data()), size, bytes.size()));
  return bytes;
}

[[noreturn]] void print_targets() {
  for (const Target& target : lightwell::fuzz::targets()) {
    std::printf("%.*s %.*s\n", static_cast<int>(target.name.size()), target.name.data(),
                static_cast<int>(target.sources.size()), target.sources.data());
  }
  std::exit(0);
}

}  // namespace

extern "C" int LLVMFuzzerInitialize(int* count, char*** arguments) {
  constexpr std::string_view option = "--target=";
  for (int i = 1; i < *count; ++i) {
    const std::string_view argument = (*arguments)[i];
    if (argument == "--targets") print_targets();
    if (!argument.starts_with(option)) continue;
    const auto all = lightwell::fuzz::targets();
    const auto found = std::ranges::find(all, argument.substr(option.size()), &Target::name);
    if (found != all.end()) chosen = &*found;
  }
  if (chosen) return 0;
  std::fputs("error: no target is chosen; give --target=NAME, a name that --targets prints.\n",
             stderr);
  std::exit(2);
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    chosen->read({reinterpret_cast<const char*>(data), size});
  } catch (const lightwell::InputError&) {
    // The reader has refused the file, as it should.
  }
  return 0;
}

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size,
                                               std::size_t longest, unsigned seed) {
  if (!chosen->mutate) return LLVMFuzzerMutate(data, size, longest);
  const std::string changed =
      chosen->mutate({reinterpret_cast<const char*>(data), size}, mutate_bytes, seed);
  if (changed.size() > longest) return LLVMFuzzerMutate(data, size, longest);
  std::copy(changed.begin(), changed.end(), reinterpret_cast<char*>(data));
  return changed.size();
}
