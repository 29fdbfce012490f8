#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/temporary_folder.h"

namespace lightwell {

struct Glb {
  nlohmann::json json;
  std::string binary;
};

inline Glb parse_glb(const std::string& bytes) {
  const auto word = [&](std::size_t at) {
    std::uint32_t value = 0;
    std::memcpy(&value, bytes.data() + at, 4);
    return value;
  };
  EXPECT_EQ(bytes.substr(0, 4), "glTF");
  EXPECT_EQ(word(4), 2u);
  EXPECT_EQ(word(8), bytes.size());
  const std::size_t length = word(12);
  EXPECT_EQ(bytes.substr(16, 4), "JSON");
  EXPECT_EQ(bytes.substr(20 + length + 4, 4), std::string("BIN\0", 4));
  EXPECT_EQ(word(20 + length), bytes.size() - 28 - length);
  return {nlohmann::json::parse(bytes.substr(20, length)), bytes.substr(28 + length)};
}

/// The numbers of an accessor, `columns` for each element.
inline std::vector<float> floats(const Glb& glb, int accessor, int columns) {
  const nlohmann::json& a = glb.json["accessors"][accessor];
  const nlohmann::json& view = glb.json["bufferViews"][a["bufferView"].get<int>()];
  std::vector<float> values(a["count"].get<std::size_t>() * columns);
  std::memcpy(values.data(),
              glb.binary.data() + view["byteOffset"].get<std::size_t>() +
                  a["byteOffset"].get<std::size_t>(),
              4 * values.size());
  return values;
}

/// True if node, which runs Khronos' validator, is installed.
inline bool has_node() {
  return std::system("node --version >/dev/null 2>&1") == 0;
}

/// True if the validator finds neither errors nor warnings; prints them otherwise.
inline bool is_valid_gltf(const TemporaryFolder& folder, const std::filesystem::path& glb) {
  const auto script =
      folder.write("validate.js",
                   "const validator = require('" LIGHTWELL_TEST_DATA
                   "/gltf-validator'), fs = require('fs');\n"
                   "(async () => {\n"
                   "  const report = await validator.validateBytes(new Uint8Array("
                   "fs.readFileSync(process.argv[2])));\n"
                   "  const {numErrors, numWarnings, messages} = report.issues;\n"
                   "  if (numErrors + numWarnings > 0) { console.error(JSON.stringify(messages)); "
                   "process.exit(1); }\n"
                   "})();\n");
  const std::string command = "node '" + script.string() + "' '" + glb.string() + "'";
  return std::system(command.c_str()) == 0;
}

}  // namespace lightwell
