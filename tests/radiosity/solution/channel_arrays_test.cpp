#include "radiosity/solution/channel_arrays.h"

#include <gtest/gtest.h>

#include <functional>

#include "radiosity/solution/relight.h"
#include "radiosity/solution/solution_file.h"
#include "scene/errors.h"
#include "tests/radiosity/small_solution.h"

namespace lightwell::channel_arrays_test {
namespace {

using ChannelArrays = SolutionFile;

BandArray light(int rows, int bands, int seed) {
  BandArray values(rows, bands);
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    values.data()[i] = static_cast<float>(i + seed) / 7.0f;
  }
  return values;
}

// Two channels on the two patches of the small solution; the second patch emits nothing.
SolvedScene two_channels(int bands = 3, bool with_caustics = true) {
  SolvedScene solved = small_solution(bands);
  RadiositySolution& s = solved.solution;
  for (int c = 0; c < 2; ++c) {
    LightChannel channel{.name = c == 0 ? "<desk> & \"lamp\"=1" : "décke",
                         .surfaces = {"a", "b <c>"},
                         .scale = constant_spectrum(s.bands, 1.0f),
                         .patch_radiosity = light(2, bands, c),
                         .direct_irradiance = light(9, bands, 10 + c),
                         .indirect_irradiance = light(9, bands, 20 + c)};
    if (c == 1) channel.surfaces.pop_back();
    if (with_caustics) channel.caustic_irradiance = light(9, bands, 30 + c);
    channel.energy = BandEnergy::Constant(4, bands, 1.0 / (3 + c));
    s.channels.push_back(channel);
  }
  s.patch_channel = {1, -1};
  s.full_emission = light(2, bands, 3);
  s.full_emission.row(1).setZero();
  relight(solved, std::vector<Spectrum>{constant_spectrum(s.bands, 0.3f),
                                        constant_spectrum(s.bands, 1.0f / 3.0f)});
  return solved;
}

class ChannelBands : public SolutionFile, public testing::WithParamInterface<int> {};

TEST_P(ChannelBands, AreRestoredBitForBit) {
  for (const bool with_caustics : {true, false}) {
    const SolvedScene solved = two_channels(GetParam(), with_caustics);
    write_solution(file(), solved);
    const SolvedScene again = read_solution(file());
    const RadiositySolution &s = solved.solution, &t = again.solution;
    EXPECT_EQ(s.patch_channel, t.patch_channel);
    EXPECT_TRUE((s.full_emission == t.full_emission).all());
    ASSERT_EQ(t.channels.size(), 2u);
    for (std::size_t c = 0; c < 2; ++c) {
      const LightChannel &a = s.channels[c], &b = t.channels[c];
      EXPECT_EQ(a.name, b.name);
      EXPECT_EQ(a.surfaces, b.surfaces);
      EXPECT_TRUE((a.scale == b.scale).all());
      EXPECT_TRUE((a.energy == b.energy).all());
      EXPECT_TRUE((a.patch_radiosity == b.patch_radiosity).all());
      EXPECT_TRUE((a.direct_irradiance == b.direct_irradiance).all());
      EXPECT_TRUE((a.indirect_irradiance == b.indirect_irradiance).all());
      ASSERT_EQ(a.caustic_irradiance.size(), b.caustic_irradiance.size());
      EXPECT_TRUE((a.caustic_irradiance == b.caustic_irradiance).all());
    }
    // Readers without channels use the sum.
    EXPECT_TRUE((s.indirect_irradiance == t.indirect_irradiance).all());
    EXPECT_TRUE((solved.mesh.emission == again.mesh.emission).all());
    EXPECT_EQ(s.energy.absorbed, t.energy.absorbed);
  }
}
INSTANTIATE_TEST_SUITE_P(Bands, ChannelBands, testing::Values(1, 3, max_bands));

TEST_F(ChannelArrays, AFileWithoutChannelsHasNoneOfTheirArrays) {
  write_solution(file(), small_solution(3));
  EXPECT_EQ(contents(file()).find("channel"), std::string::npos);
  EXPECT_TRUE(read_solution(file()).solution.channels.empty());
}

TEST_F(ChannelArrays, TheFileBeginsWithTheirNamesAndScales) {
  write_solution(file(), two_channels());
  EXPECT_NE(contents(file()).find("channels: "), std::string::npos);
  EXPECT_NE(contents(file()).find("décke 0.3333"), std::string::npos);
}

struct Damage {
  const char* name;
  std::function<void(RadiositySolution&)> make;
  const char* reason;
};

std::ostream& operator<<(std::ostream& out, const Damage& damage) {
  return out << damage.name;
}

class DamagedChannels : public SolutionFile, public testing::WithParamInterface<Damage> {};

TEST_P(DamagedChannels, AreRefused) {
  SolvedScene solved = two_channels();
  GetParam().make(solved.solution);
  write_solution(file(), solved);
  try {
    read_solution(file());
    FAIL() << "it was read";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find(GetParam().reason), std::string::npos) << error.what();
  }
}

const float nan = std::numeric_limits<float>::quiet_NaN();
const Damage damages[] = {
    {"missing light", [](auto& s) { s.channels[1].indirect_irradiance.resize(0, 3); },
     "'channel_1_indirect_irradiance' is missing"},
    {"missing caustics", [](auto& s) { s.channels[0].caustic_irradiance.resize(0, 3); },
     "'channel_0_caustic_irradiance' is missing"},
    {"missing radiosity", [](auto& s) { s.channels[0].patch_radiosity.resize(0, 3); },
     "'channel_0_patch_radiosity' is missing"},
    {"one patch too many", [](auto& s) { s.channels[1].patch_radiosity = light(3, 3, 0); },
     "'channel_1_patch_radiosity' has 3 rows instead of 2"},
    {"one band too few", [](auto& s) { s.channels[1].patch_radiosity = light(2, 2, 0); },
     "'channel_1_patch_radiosity' has 2 columns instead of 3"},
    {"light that is no number", [](auto& s) { s.channels[1].direct_irradiance(3, 1) = nan; },
     "'channel_1_direct_irradiance' holds a value that is not finite"},
    {"scale that is no number", [](auto& s) { s.channels[1].scale[1] = nan; },
     "'channel_scale' holds a value that is not finite"},
    {"negative scale", [](auto& s) { s.channels[0].scale[2] = -0.5f; },
     "'channel_scale' holds a negative number"},
    {"energy that is no number", [](auto& s) { s.channels[0].energy(2, 1) = nan; },
     "energy of a channel is not finite"},
    {"one name twice", [](auto& s) { s.channels[0].name = s.channels[1].name; }, "used twice"},
    {"no name", [](auto& s) { s.channels[0].name.clear(); }, "is empty"},
    {"a patch in no channel there is", [](auto& s) { s.patch_channel[0] = 2; },
     "'patch_channel' holds 2"},
    {"an emitter in no channel", [](auto& s) { s.patch_channel[0] = -1; }, "in no channel"},
    {"negative emission", [](auto& s) { s.full_emission(0, 1) = -1.0f; }, "has negative emission"},
    {"no emission", [](auto& s) { s.full_emission.resize(0, 3); },
     "'patch_full_emission' is missing"}};
INSTANTIATE_TEST_SUITE_P(OneByOne, DamagedChannels, testing::ValuesIn(damages));

}  // namespace
}  // namespace lightwell::channel_arrays_test
