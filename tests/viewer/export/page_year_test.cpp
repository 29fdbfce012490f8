// Data of a page of a year of daylight, read without a browser.
#include "viewer/export/page_year.h"

#include <gtest/gtest.h>

#include "scene/errors.h"
#include "scene/specular.h"
#include "tests/viewer/page_values.h"
#include "tests/viewer/year_room.h"

namespace lightwell::page_year_test {
namespace {

using Json = nlohmann::ordered_json;

std::vector<float> halves(const PageData& page, const Json& place, std::size_t count) {
  std::vector<float> values;
  for (const std::uint16_t bits : values_at<std::uint16_t>(page, place, count)) {
    values.push_back(place["scale"].get<float>() * half_to_float(bits));
  }
  return values;
}

class PageOfAYear : public testing::Test {
 protected:
  const test::ComputedRoom& room = test::glazed_year();
  const BakedModel model = room.page();
  const PageData page = page_data(model, {.low = 0.0, .high = 1000.0});
  const Json& year = page.about["year"];
  const std::size_t terms = year["terms"].get<std::size_t>(),
                    count = static_cast<std::size_t>(model.vertex_count());
};

}  // namespace

// The sum of the page, weights times terms, is the light of the basis in every hour. Both factors
// have 11 bits, and each product the error of both, 2^-10.
TEST_F(PageOfAYear, WeightsTimesTermsAreTheLightOfEachHour) {
  ASSERT_EQ(year["bands"], 3);
  const std::vector<float> light = halves(page, year["light"], 3 * terms * count),
                           weights =
                               halves(page, year["hours"]["weights"], terms * room.hours.size());
  for (std::size_t h = 0; h < room.hours.size(); h += 5) {
    const BandArray wanted = light_of_hour(room.basis, static_cast<int>(h), 3);
    for (std::size_t i = 0; i < count; i += 7) {
      for (std::size_t band = 0; band < 3; ++band) {
        float sum = 0.0f, sizes = 0.0f;
        for (std::size_t k = 0; k < terms; ++k) {
          const float product = weights[terms * h + k] * light[terms * (3 * i + band) + k];
          sum += product;
          sizes += std::abs(product);
        }
        EXPECT_NEAR(sum, wanted(model.mesh_vertex[i], static_cast<Eigen::Index>(band)),
                    std::exp2(-10.0f) * sizes);
      }
    }
  }
}

// Skies are those of the hours, in single precision.
TEST_F(PageOfAYear, HoursHaveTheirSkies) {
  const Json& hours = year["hours"];
  ASSERT_EQ(hours["count"], room.hours.size());
  const auto numbers =
      values_at<std::uint32_t>(page, {{"offset", hours["numbers"]}}, room.hours.size());
  const auto skies = values_at<float>(page, {{"offset", hours["skies"]}}, 7 * room.hours.size());
  for (std::size_t h = 0; h < room.hours.size(); ++h) {
    EXPECT_EQ(numbers[h], static_cast<std::uint32_t>(room.hours[h].number));
    EXPECT_EQ(skies[7 * h], static_cast<float>(room.hours[h].sun_lux));
    EXPECT_EQ(skies[7 * h + 1], static_cast<float>(room.hours[h].dome_lux));
    EXPECT_EQ(skies[7 * h + 6], static_cast<float>(room.hours[h].gradation.e));
  }
}

// Each place of a pane counts once, on whatever sides the page has it: faces that count have the
// pane's 2 m^2. At normal incidence, glass of index 1.5 reflects R = 0.04 at each face, and passes
// (1 - R) / (1 + R) with all reflections inside.
TEST_F(PageOfAYear, PanesCountOnceAndPassLightByItsAngle) {
  const Json& panes = year["panes"];
  const auto of_face = values_at<std::uint8_t>(page, {{"offset", panes["of_face"]}},
                                               static_cast<std::size_t>(model.face_count()));
  double area = 0.0;
  for (std::size_t f = 0; f < of_face.size(); ++f) {
    const bool is_glass =
        model
            .materials[static_cast<std::size_t>(std::ranges::find_if(model.parts,
                                                                     [&](const BakedPart& part) {
                                                                       return static_cast<int>(f) <
                                                                              part.first_face +
                                                                                  part.face_count;
                                                                     })
                                                    ->material)]
            .is_glass;
    EXPECT_EQ(of_face[f] != 0, is_glass);
    if (of_face[f] == 1) area += room.model.mesh().element_area[model.element[f]];
  }
  EXPECT_NEAR(area, 2.0, 1e-9);
  const Json& table = panes["transmittance"][0];
  const std::size_t steps = panes["steps"];
  ASSERT_EQ(table.size(), 3 * (steps + 1));
  EXPECT_NEAR(table[3 * steps].get<double>(), 0.96 / 1.04, 1e-6);  // single precision
  EXPECT_EQ(table[0], 0.0);
}

}  // namespace lightwell::page_year_test
