#include "daylight/year_files.h"

#include <gtest/gtest.h>

#include <cstring>
#include <fstream>
#include <iterator>
#include <string>

#include "tests/temporary_folder.h"

namespace lightwell::year_files_test {
namespace {

std::string bytes_of(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

}  // namespace

// Format 1.0 of NumPy: magic, version, length of the header, a Python dictionary, rows.
TEST(NumpyRows, HaveTheShapeAndOrderOfNumpy) {
  const TemporaryFolder folder;
  const auto file = folder / "a.npy";
  {
    NumpyRows rows(file, 2);
    rows.append((Eigen::ArrayXXf(2, 2) << 1.0f, 3.0f, 2.0f, 4.0f).finished());
    rows.append((Eigen::ArrayXXf(2, 1) << 5.0f, 6.0f).finished());
    rows.commit();
  }
  const std::string bytes = bytes_of(file);
  ASSERT_EQ(bytes.size(), 128 + 6 * sizeof(float));
  EXPECT_EQ(bytes.substr(0, 8), std::string("\x93NUMPY\x01\x00", 8));
  EXPECT_EQ(static_cast<unsigned char>(bytes[8]) + 256 * static_cast<unsigned char>(bytes[9]), 118);
  EXPECT_NE(bytes.find("'descr': '<f4', 'fortran_order': False, 'shape': (3, 2)"),
            std::string::npos);
  EXPECT_EQ(bytes[127], '\n');
  std::array<float, 6> values{};
  std::memcpy(values.data(), bytes.data() + 128, sizeof values);
  for (int i = 0; i < 6; ++i) EXPECT_EQ(values[static_cast<std::size_t>(i)], i + 1.0f);
}

TEST(NumpyRows, LeaveNoFileWithoutCommit) {
  const TemporaryFolder folder;
  { NumpyRows(folder / "a.npy", 2).append(Eigen::ArrayXXf::Ones(2, 3)); }
  EXPECT_EQ(folder.file_count(), 0);
}

}  // namespace lightwell::year_files_test
