// Data of a walkthrough page, read without a browser.
#include "viewer/export/page_data.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <filesystem>

#include "tests/temporary_folder.h"
#include "tests/viewer/lit_sides.h"
#include "tests/viewer/page_values.h"
#include "viewer/export/baked_channels.h"
#include "viewer/export/export.h"

namespace lightwell::page_data_test {
namespace {

using Json = nlohmann::ordered_json;

Eigen::Vector3d vector_of(const Json& json) {
  return {json[0].get<double>(), json[1].get<double>(), json[2].get<double>()};
}

/// solved_box() far from the origin, with z up and two bright corners.
SolvedScene far_box() {
  SolvedScene box = solved_box();
  for (int v = 0; v < box.mesh.vertex_count(); ++v) {
    const Eigen::Vector3d p = box.mesh.position(v) + Eigen::Vector3d(4e5, 7e6, -30.0);
    box.mesh.elements->set_point(HalfedgeMesh::VertexHandle(v), {p.x(), p.y(), p.z()});
  }
  box.solution.direct_irradiance(3, 0) = 1e4f;
  box.solution.direct_irradiance(5, 2) = 1e-3f;
  return box;
}

Scene scene_with_z_up() {
  Scene scene = box_scene();
  scene.cameras[0].up = {0, 0, 1};
  scene.cameras[0].direction = {0, 1, 0};
  scene.cameras[0].position = {4e5 + 1, 7e6 - 3, -29};
  return scene;
}

class PageOf : public testing::Test {
 protected:
  const BakedModel model = bake_model(far_box(), scene_with_z_up());
  const PageData page = page_data(model, {.low = 0.0, .high = 1000.0});
  const std::size_t n = static_cast<std::size_t>(model.vertex_count());

  Eigen::Vector3d to_scene(const Eigen::Vector3d& p) const {
    Eigen::Matrix3d turn;
    for (int c = 0; c < 3; ++c) turn.row(c) = vector_of(page.about["to_scene"][c]).transpose();
    return turn * (p + vector_of(page.about["origin"]));
  }
};

/// Positions have 21 bits along the longest side: their error is half a step of 2 m / (2^21 - 1)
/// for any position of the room.
TEST_F(PageOf, PositionsAreKeptToHalfAStep) {
  const auto packed = values_at<std::uint64_t>(page, page.about["positions"], n);
  const double step = page.about["positions"]["step"];
  EXPECT_DOUBLE_EQ(step, 2.0 / 2097151.0);
  for (std::size_t v = 0; v < n; ++v) {
    const Eigen::Vector3d place(packed[v] & 0x1fffff, packed[v] >> 21 & 0x1fffff, packed[v] >> 42);
    const Eigen::Vector3d found = to_scene(step * place);
    // The rounding error of 7e6 in double precision is 1e-9.
    EXPECT_LE((found - model.position[v]).cwiseAbs().maxCoeff(), 0.5 * step + 2e-9);
  }
}

/// Half floats have 11 significant bits for numbers down to 2e-9 of the largest.
TEST_F(PageOf, LightIsKeptToElevenBits) {
  const Json& basis = page.about["bases"][0];
  const auto check = [&](const Json& place, const float* wanted, std::size_t count) {
    const float scale = place["scale"];
    const auto bits = values_at<std::uint16_t>(page, place, count);
    for (std::size_t i = 0; i < count; ++i) {
      const float value = scale * half_to_float(bits[i]);
      EXPECT_NEAR(value, wanted[i], std::abs(wanted[i]) * std::exp2(-11.0f));
    }
  };
  ASSERT_EQ(page.about["bases"].size(), 1u);
  check(basis["radiance"], model.radiance.data(), 3 * n);
  const RgbArray shares = illuminance_shares(model.irradiance, model.bands);
  check(basis["illuminance"], shares.data(), 3 * n);
  for (std::size_t v = 0; v < n; ++v) {  // single precision
    EXPECT_NEAR(shares.row(v).sum(), model.illuminance[v], 1e-6 * model.illuminance[v]);
  }
}

/// Bands whose primaries have other luminances than those of Rec. 709, as RADIANCE's do.
TEST(PageOfOtherPrimaries, WeighsLightAsItsBandsDo) {
  SolvedScene box = solved_box();
  box.solution.bands.xyz.row(1) << 0.25f, 0.625f, 0.125f;
  box.solution.direct_irradiance.col(0) *= 2.0f;  // not white
  const BakedModel model = bake_model(box, box_scene());
  const PageData page = page_data(model, {.low = 0.0, .high = 1000.0});
  // Eighths are exact in floats.
  EXPECT_EQ(page.about["luminance_weights"], (Json{0.25, 0.625, 0.125}));
  const RgbArray shares = illuminance_shares(model.irradiance, model.bands);
  for (int v = 0; v < model.vertex_count(); ++v) {  // single precision
    const float lux = model.illuminance[static_cast<std::size_t>(v)];
    EXPECT_NEAR(shares.row(v).sum(), lux, 1e-6 * lux);
  }
}

TEST_F(PageOf, FacesAndTheirPartsAreAllThere) {
  const auto corners = values_at<std::int32_t>(page, page.about["corners"], 4 * model.faces.size());
  for (std::size_t f = 0; f < model.faces.size(); ++f) {
    for (std::size_t c = 0; c < 4; ++c) EXPECT_EQ(corners[4 * f + c], model.faces[f][c]);
  }
  const auto behind = values_at<std::uint8_t>(page, page.about["black_behind"], model.faces.size());
  EXPECT_EQ(behind, model.black_behind);
  int next = 0;
  for (const Json& part : page.about["parts"]) {
    EXPECT_EQ(part["first_face"], next);
    next += part["face_count"].get<int>();
  }
  EXPECT_EQ(next, model.face_count());
}

TEST_F(PageOf, CamerasStandWhereTheyStood) {
  const Json& camera = page.about["cameras"][0];
  EXPECT_LT(
      (to_scene(vector_of(camera["position"])) - Eigen::Vector3d(4e5 + 1, 7e6 - 3, -29)).norm(),
      4e-9);
  EXPECT_EQ(vector_of(camera["up"]), Eigen::Vector3d(0, 1, 0));
  EXPECT_EQ(vector_of(camera["direction"]), Eigen::Vector3d(0, 0, -1));
  EXPECT_EQ(camera["exposure"], model.cameras[0].scale);
}

/// Test vectors of RFC 4648, section 10.
TEST(Base64, IsThatOfTheStandard) {
  EXPECT_EQ(base64(""), "");
  EXPECT_EQ(base64("f"), "Zg==");
  EXPECT_EQ(base64("fo"), "Zm8=");
  EXPECT_EQ(base64("foo"), "Zm9v");
  EXPECT_EQ(base64("foobar"), "Zm9vYmFy");
  EXPECT_EQ(base64("\xff\xfe\xfb"), "//77");
}

int count_of(const std::string& text, const std::string& part) {
  int count = 0;
  for (std::size_t at = 0; (at = text.find(part, at)) != std::string::npos; ++at) ++count;
  return count;
}

/// A script element ends at the first "</script", unless "<!--" precedes it.
TEST(Walkthrough, NamesCannotBreakThePage) {
  const TemporaryFolder folder;
  Scene scene = box_scene();
  write_walkthrough(folder / "plain.html", bake_model(solved_box(), scene));
  scene.surfaces[0].name = "</script><script>alert(1)</script><!--";
  scene.cameras[0].name = "</ScRiPt>";
  scene.title = "a </title> & more";
  write_walkthrough(folder / "odd.html", bake_model(solved_box(), scene));
  const std::string plain = content_of(folder / "plain.html"),
                    odd = content_of(folder / "odd.html");
  for (const char* part : {"</script", "<script", "</ScRiPt", "<!--", "</title"}) {
    EXPECT_EQ(count_of(odd, part), count_of(plain, part)) << part;
  }
  EXPECT_TRUE(says(odd, "<title>a &lt;/title> &amp; more</title>"));
  const std::string mark = "id=\"about\">";
  const std::size_t begin = odd.find(mark) + mark.size();
  const Json about = Json::parse(odd.substr(begin, odd.find("</script", begin) - begin));
  EXPECT_EQ(about["parts"][0]["name"], scene.surfaces[0].name);
}

/// A page has no address to fetch: addresses occur only in licences and in the library's texts.
TEST(Walkthrough, HoldsAllThatItNeeds) {
  const TemporaryFolder folder;
  write_walkthrough(folder / "box.html", bake_model(solved_box(), box_scene()));
  const std::string page = content_of(folder / "box.html");
  for (const char* part : {"src=\"", "href=\"", "@import", "url("}) {
    EXPECT_EQ(count_of(page.substr(0, page.find("id=\"licenses\"")), part), 0) << part;
  }
  EXPECT_EQ(count_of(page, "{{"), 0);
  EXPECT_TRUE(says(page, "three.js authors"));
}

/// The largest data of 100 000 elements are quadrilaterals without shared vertices. Pages are sent
/// by mail, with limits from 20 MB.
TEST(PageSize, OfAHundredThousandElementsIsBelowFifteenMegabytes) {
  SolvedQuads quads;
  constexpr int side = 317;  // 100 489 quads
  for (int i = 0; i < side * side; ++i) {
    const double x = i % side, y = i / side;
    quads.add({{{x, y, 0}, {x + 1, y, 0}, {x + 1, y + 1, 0}, {x, y + 1, 0}}},
              {white, red, Eigen::Array3f(white * 0.001f * static_cast<float>(x)), grey});
  }
  SolvedScene solved = quads.solved();
  std::ranges::fill(solved.mesh.surface, 0);
  std::ranges::fill(solved.mesh.material, 0);
  const TemporaryFolder folder;
  write_walkthrough(folder / "page.html", bake_model(solved, box_scene()));
  EXPECT_LT(std::filesystem::file_size(folder / "page.html"), 15'000'000u);
}

}  // namespace
}  // namespace lightwell::page_data_test
