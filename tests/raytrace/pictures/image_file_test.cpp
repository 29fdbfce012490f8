#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <ImfOutputFile.h>
#include <ImfStandardAttributes.h>
#include <ImfStringAttribute.h>
#include <ImfVecAttribute.h>
#include <gtest/gtest.h>
#include <png.h>

#include <algorithm>
#include <cstdio>
#include <limits>

#include "raytrace/pictures/image.h"
#include "scene/errors.h"
#include "scene/sampling.h"
#include "tests/temporary_folder.h"

namespace lightwell::image_file_test {
namespace {

// A picture of different floats: huge, tiny and negative.
Image noise(int width, int height, int bands) {
  Image image{.width = width, .height = height};
  image.radiance.resize(width * height, bands);
  for (Eigen::Index i = 0; i < image.radiance.size(); ++i) {
    const double u = random_uniform(static_cast<std::uint64_t>(i));
    image.radiance.data()[i] = static_cast<float>(std::exp2(60.0 * u - 30.0) * (u > 0.9 ? -1 : 1));
  }
  return image;
}

TEST(Exr, RoundTripKeepsEveryBit) {
  const TemporaryFolder folder;
  const Image written = noise(37, 23, 3);
  write_exr(folder / "a.exr", written, rgb_bands());
  const Image read = read_exr(folder / "a.exr");
  EXPECT_EQ(read.width, 37);
  EXPECT_EQ(read.height, 23);
  EXPECT_TRUE((read.radiance == written.radiance).all());
  EXPECT_EQ(folder.file_count(), 1);
}

TEST(Exr, KeepsMetadataAsStringAttributes) {
  const TemporaryFolder folder;
  write_exr(folder / "a.exr", noise(4, 4, 3), rgb_bands(),
            {{"camera", "front"}, {"made with", "lightwell render"}});
  const Imf::InputFile file((folder / "a.exr").c_str());
  EXPECT_EQ(file.header().typedAttribute<Imf::StringAttribute>("camera").value(), "front");
  EXPECT_EQ(file.header().typedAttribute<Imf::StringAttribute>("made with").value(),
            "lightwell render");
}

TEST(Exr, SpectralImageCarriesItsBandsAndTheirColour) {
  const TemporaryFolder folder;
  const Bands bands = spectral_bands(400, 700, 6);
  const Image written = noise(5, 3, 6);
  write_exr(folder / "a.exr", written, bands);

  Imf::InputFile file((folder / "a.exr").c_str());
  std::vector<float> band(15);
  Imf::FrameBuffer buffer;
  buffer.insert(bands.names[4], Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(band.data()),
                                           sizeof(float), 5 * sizeof(float)));
  file.setFrameBuffer(buffer);
  file.readPixels(0, 2);
  const Image rgb = read_exr(folder / "a.exr");
  for (int i = 0; i < 15; ++i) {
    EXPECT_EQ(band[i], written.radiance(i, 4));
    const Eigen::Array3f expected = linear_rgb(bands, written.radiance.row(i).transpose());
    EXPECT_TRUE((rgb.radiance.row(i).transpose() == expected).all());
  }
}

TEST(Exr, HalfFloatsInAWindowOffTheOriginAreRead) {
  const TemporaryFolder folder;
  const Imath::Box2i window({-2, 5}, {0, 6});  // 3 x 2 pixels
  Imf::Header header(window, window);
  std::vector<half> values(18);
  for (int i = 0; i < 18; ++i) values[i] = static_cast<float>(i);
  Imf::FrameBuffer buffer;
  for (int k = 0; k < 3; ++k) {
    const std::string name(1, "RGB"[k]);
    header.channels().insert(name, Imf::Channel(Imf::HALF));
    const std::ptrdiff_t origin = 3 * (-2 + 5 * 3);
    buffer.insert(name, Imf::Slice(Imf::HALF, reinterpret_cast<char*>(values.data() + k - origin),
                                   3 * sizeof(half), 9 * sizeof(half)));
  }
  {
    Imf::OutputFile file((folder / "h.exr").c_str(), header);
    file.setFrameBuffer(buffer);
    file.writePixels(2);
  }
  const Image image = read_exr(folder / "h.exr");
  ASSERT_EQ(image.width, 3);
  ASSERT_EQ(image.height, 2);
  for (int i = 0; i < 18; ++i) EXPECT_EQ(image.radiance.data()[i], static_cast<float>(i));
}

// A picture with radiance and a layer of each kind.
Image layered() {
  Image image = noise(6, 4, 3);
  image.radiance = image.radiance.abs().min(6e4f);
  image.layers.names = {"albedo.R", "albedo.G", "albedo.B", "depth.Z", "luminance.Y", "patch.id"};
  image.layers.values.resize(24, 6);
  for (int i = 0; i < 24; ++i) {
    image.layers.values.row(i) << 0.1f, 0.2f, 0.3f, 1.0f + 0.001f * i, 1e6f + i, 70001.0f + i;
  }
  image.layers.values(0, 3) = std::numeric_limits<float>::infinity();
  return image;
}

TEST(Exr, LayersComeBackUnderTheirNamesEveryBitOfThem) {
  for (const auto compression : {ExrCompression::none, ExrCompression::rle, ExrCompression::zips,
                                 ExrCompression::zip, ExrCompression::piz}) {
    const TemporaryFolder folder;
    const Image written = layered();
    write_exr(folder / "a.exr", written, rgb_bands(), {}, {.compression = compression});
    const Image read = read_exr(folder / "a.exr", ExrChannels::all);
    EXPECT_TRUE((read.radiance == written.radiance).all());
    std::vector<std::string> sorted = written.layers.names;  // as OpenEXR keeps them
    std::sort(sorted.begin(), sorted.end());
    ASSERT_EQ(read.layers.names, sorted);
    for (std::size_t k = 0; k < sorted.size(); ++k) {
      const auto& names = written.layers.names;
      const auto from = std::find(names.begin(), names.end(), sorted[k]) - names.begin();
      EXPECT_TRUE(
          (read.layers.values.col(static_cast<Eigen::Index>(k)) == written.layers.values.col(from))
              .all())
          << sorted[k];
    }
    EXPECT_TRUE(read_exr(folder / "a.exr").layers.is_empty());
  }
}

TEST(Exr, HalfFloatsRoundLightButNotDistancesPatchesOrCandelas) {
  const TemporaryFolder folder;
  const Image written = layered();
  write_exr(folder / "a.exr", written, rgb_bands(), {}, {.half = true});
  const Image read = read_exr(folder / "a.exr", ExrChannels::all);
  // Half floats have 11 bits: half a unit in the last place is 2^-11 relative, or 2^-25 absolute
  // below the smallest normal number.
  EXPECT_TRUE(
      ((read.radiance - written.radiance).abs() <= 0x1p-11f * written.radiance + 0x1p-25f).all());
  EXPECT_FALSE((read.radiance == written.radiance).all());
  EXPECT_TRUE((read.layers.values.rightCols(3) == written.layers.values.rightCols(3)).all());
  const Imf::InputFile file((folder / "a.exr").c_str());
  const Imf::ChannelList& channels = file.header().channels();
  for (const char* name : {"R", "G", "B", "albedo.R", "albedo.G", "albedo.B"}) {
    EXPECT_EQ(channels[name].type, Imf::HALF) << name;
  }
  for (const char* name : {"depth.Z", "luminance.Y", "patch.id"}) {
    EXPECT_EQ(channels[name].type, Imf::FLOAT) << name;
  }
}

TEST(Exr, ValueBeyondHalfFloatsIsNamedAndNothingIsWritten) {
  const TemporaryFolder folder;
  Image bright = layered();
  bright.radiance(8, 1) = 7e4f;
  const auto message = message_of<std::runtime_error>(
      [&] { write_exr(folder / "a.exr", bright, rgb_bands(), {}, {.half = true}); });
  EXPECT_TRUE(says(message, "a.exr"));
  EXPECT_TRUE(says(message, "channel 'G' is 70000 at pixel (2, 1)")) << message;
  EXPECT_EQ(folder.file_count(), 0);
}

TEST(Exr, NumbersAndDirectionsKeepTheirTypesAsAttributes) {
  const TemporaryFolder folder;
  write_exr(folder / "a.exr", noise(2, 2, 3), rgb_bands(),
            {{"whiteLuminance", 683.0}, {"cameraPosition", Eigen::Vector3d(1, 2, 0.1)}});
  const Imf::InputFile file((folder / "a.exr").c_str());
  EXPECT_EQ(Imf::whiteLuminance(file.header()), 683.0f);
  const auto& at = file.header().typedAttribute<Imf::V3dAttribute>("cameraPosition").value();
  EXPECT_EQ(at, Imath::V3d(1, 2, 0.1));
  EXPECT_TRUE(Imf::hasChromaticities(file.header()));
}

TEST(Exr, FailedWriteNamesTheFileAndLeavesNothing) {
  const TemporaryFolder folder;
  const auto path = folder / "missing" / "a.exr";
  const auto message =
      message_of<std::runtime_error>([&] { write_exr(path, noise(2, 2, 3), rgb_bands()); });
  EXPECT_TRUE(says(message, path.string()));
  EXPECT_EQ(folder.file_count(), 0);
}

TEST(Exr, FullDiskIsAnErrorNotAShortFile) {
  // Every write to /dev/full fails with "no space left on device".
  const TemporaryFolder folder;
  const auto temporary = folder / ("a.exr." + std::to_string(::getpid()) + ".part");
  std::filesystem::create_symlink("/dev/full", temporary);
  EXPECT_THROW(write_exr(folder / "a.exr", noise(64, 64, 3), rgb_bands()), std::runtime_error);
  EXPECT_EQ(folder.file_count(), 0);
}

TEST(Exr, FailedRenameKeepsWhatWasThere) {
  const TemporaryFolder folder;
  std::filesystem::create_directories(folder / "taken" / "inside");
  const auto message = message_of<std::runtime_error>(
      [&] { write_exr(folder / "taken", noise(2, 2, 3), rgb_bands()); });
  EXPECT_TRUE(says(message, "taken"));
  EXPECT_TRUE(std::filesystem::exists(folder / "taken" / "inside"));
  EXPECT_EQ(folder.file_count(), 1);
}

TEST(Exr, BadInputIsRefusedWithItsName) {
  const TemporaryFolder folder;
  const auto read = [&](const std::filesystem::path& path) {
    return message_of<InputError>([&] { read_exr(path); });
  };
  EXPECT_TRUE(says(read(folder / "none.exr"), "none.exr"));
  EXPECT_TRUE(says(read(folder.write("text.exr", "not a picture")), "text.exr"));
  EXPECT_TRUE(says(read(folder.write("empty.exr", "")), "empty.exr"));

  write_exr(folder / "whole.exr", noise(64, 64, 3), rgb_bands());
  std::filesystem::resize_file(folder / "whole.exr", 5000);
  EXPECT_TRUE(says(read(folder / "whole.exr"), "whole.exr"));
}

TEST(Exr, MissingChannelIsNamed) {
  const TemporaryFolder folder;
  Imf::Header header(2, 1);
  header.channels().insert("R", Imf::Channel(Imf::FLOAT));
  header.channels().insert("Z", Imf::Channel(Imf::FLOAT));
  { Imf::OutputFile file((folder / "depth.exr").c_str(), header); }
  const auto message = message_of<InputError>([&] { read_exr(folder / "depth.exr"); });
  EXPECT_TRUE(says(message, "channel 'G'"));
}

TEST(Exr, HugeHeaderIsRefusedBeforeItIsBelieved) {
  const TemporaryFolder folder;
  Imf::Header header(100000, 100000);
  for (const char* name : {"R", "G", "B"}) {
    header.channels().insert(name, Imf::Channel(Imf::FLOAT));
  }
  { Imf::OutputFile file((folder / "huge.exr").c_str(), header); }
  const auto message = message_of<InputError>([&] { read_exr(folder / "huge.exr"); });
  EXPECT_TRUE(says(message, "100000 x 100000"));
}

TEST(Exr, ImageThatDoesNotMatchItsBandsIsRefused) {
  const TemporaryFolder folder;
  EXPECT_THROW(write_exr(folder / "a.exr", noise(2, 2, 4), rgb_bands()), std::runtime_error);
  Image short_of_pixels = noise(2, 2, 3);
  short_of_pixels.height = 3;
  EXPECT_THROW(write_exr(folder / "a.exr", short_of_pixels, rgb_bands()), std::runtime_error);
  EXPECT_EQ(folder.file_count(), 0);
}

struct ReadPng {
  png_uint_32 width = 0, height = 0;
  std::vector<std::uint8_t> rgb{};
  std::vector<std::pair<std::string, std::string>> texts{};
};

ReadPng read_png(const std::filesystem::path& path) {
  ReadPng result;
  std::FILE* file = std::fopen(path.c_str(), "rb");
  png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png_create_info_struct(png);
  png_init_io(png, file);
  png_read_png(png, info, PNG_TRANSFORM_IDENTITY, nullptr);
  result.width = png_get_image_width(png, info);
  result.height = png_get_image_height(png, info);
  EXPECT_EQ(png_get_color_type(png, info), PNG_COLOR_TYPE_RGB);
  EXPECT_EQ(png_get_bit_depth(png, info), 8);
  int intent = -1;
  EXPECT_EQ(png_get_sRGB(png, info, &intent), static_cast<png_uint_32>(PNG_INFO_sRGB));
  png_bytepp rows = png_get_rows(png, info);
  for (png_uint_32 y = 0; y < result.height; ++y) {
    result.rgb.insert(result.rgb.end(), rows[y], rows[y] + 3 * result.width);
  }
  png_textp texts = nullptr;
  int count = 0;
  png_get_text(png, info, &texts, &count);
  for (int i = 0; i < count; ++i) result.texts.emplace_back(texts[i].key, texts[i].text);
  png_destroy_read_struct(&png, &info, nullptr);
  std::fclose(file);
  return result;
}

TEST(Png, ReadsBackWithSizePixelsAndText) {
  const TemporaryFolder folder;
  std::vector<std::uint8_t> rgb(3 * 7 * 5);
  for (std::size_t i = 0; i < rgb.size(); ++i) rgb[i] = static_cast<std::uint8_t>(i * 37);
  const std::vector<std::pair<std::string, std::string>> texts = {{"Title", "Cornell box"},
                                                                  {"Comment", "\xc2\xb5-facets"}};
  write_png(folder / "a.png", 7, 5, rgb, {texts.begin(), texts.end()});
  const ReadPng png = read_png(folder / "a.png");
  EXPECT_EQ(png.width, 7u);
  EXPECT_EQ(png.height, 5u);
  EXPECT_EQ(png.rgb, rgb);
  EXPECT_EQ(png.texts, texts);
  EXPECT_EQ(folder.file_count(), 1);
}

TEST(Png, FailuresNameTheFileAndLeaveNothing) {
  const TemporaryFolder folder;
  const std::vector<std::uint8_t> rgb(12);
  const auto fails = [&](auto&& write) { return message_of<std::runtime_error>(write); };
  EXPECT_TRUE(says(fails([&] { write_png(folder / "no" / "a.png", 2, 2, rgb); }), "a.png"));
  EXPECT_TRUE(says(fails([&] { write_png(folder / "b.png", 3, 2, rgb); }), "b.png"));
  const ImageMetadata long_key = {{std::string(80, 'k'), "value"}};
  EXPECT_TRUE(says(fails([&] { write_png(folder / "c.png", 2, 2, rgb, long_key); }), "c.png"));
  const auto temporary = folder / ("d.png." + std::to_string(::getpid()) + ".part");
  std::filesystem::create_symlink("/dev/full", temporary);
  EXPECT_TRUE(
      says(fails([&] { write_png(folder / "d.png", 2, 2, rgb); }), "No space left on device"));
  EXPECT_EQ(folder.file_count(), 0);
}

}  // namespace
}  // namespace lightwell::image_file_test
