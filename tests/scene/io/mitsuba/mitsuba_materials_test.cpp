// Materials of Mitsuba's BSDFs.
#include <gtest/gtest.h>

#include <fmt/format.h>

#include <cmath>

#include "scene/coat.h"
#include "scene/optics.h"
#include "scene/specular.h"
#include "tests/scene/io/mitsuba/mitsuba_test.h"
#include "tests/scene/scene_questions.h"

namespace lightwell::mitsuba_materials_test {
namespace {

using test::has_loss;
using test::has_note;

class MitsubaMaterials : public test::MitsubaTest {};

TEST_F(MitsubaMaterials, OneSidedUnlessTheFileSaysTwosided) {
  EXPECT_TRUE(material(R"(<bsdf type="diffuse"/>)").one_sided);
  EXPECT_FALSE(material(R"(<bsdf type="twosided"><bsdf type="diffuse"/></bsdf>)").one_sided);
  EXPECT_TRUE(material(R"(<bsdf type="bumpmap"><bsdf type="diffuse"/></bsdf>)").one_sided);
  EXPECT_FALSE(
      material(R"(<bsdf type="mask"><bsdf type="twosided"><bsdf type="plastic"/></bsdf></bsdf>)")
          .one_sided);
}

TEST_F(MitsubaMaterials, MetalsAndGlassKeepTheirGloss) {
  const Material chrome = material(R"(<bsdf type="conductor"><rgb name="eta" value="1.5"/>
      <rgb name="k" value="0"/><rgb name="specular_reflectance" value="0.5"/></bsdf>)");
  EXPECT_NEAR(mean_mirrored(chrome)[1], 0.5 * diffuse_fresnel(1.5), 1e-7);
  EXPECT_FLOAT_EQ(
      material(R"(<bsdf type="conductor"><string name="material" value="none"/></bsdf>)")
          .specular[0],
      1.0f);
  const Material brushed = material(R"(<bsdf type="roughconductor"><float name="alpha" value="0.4"/>
      <string name="material" value="none"/></bsdf>)");
  EXPECT_FLOAT_EQ(brushed.specular[0], 1.0f);
  EXPECT_FLOAT_EQ(brushed.specular_roughness, 0.4f);
  const Material matt = material(R"(<bsdf type="roughconductor"><float name="alpha" value="0.6"/>
      <string name="material" value="none"/></bsdf>)");
  EXPECT_FLOAT_EQ(matt.reflectance[0], 1.0f);
  EXPECT_FALSE(matt.is_specular());
  const Material frosted =
      material(R"(<bsdf type="roughdielectric"><float name="alpha" value="0.7"/></bsdf>)");
  EXPECT_FLOAT_EQ(frosted.dielectric.value().roughness, 0.7f);
  const Material water = material(R"(<bsdf type="dielectric"><string name="int_ior" value="water"/>
      <float name="ext_ior" value="1"/></bsdf>)");
  ASSERT_TRUE(water.dielectric.has_value());
  EXPECT_FLOAT_EQ(water.dielectric->index_of_refraction, 1.333f);
  const Material pane = material(R"(<bsdf type="thindielectric"><float name="int_ior" value="1.5"/>
      <float name="ext_ior" value="1"/></bsdf>)");
  ASSERT_TRUE(pane.dielectric.has_value());
  EXPECT_TRUE(pane.dielectric->thin);
  EXPECT_FLOAT_EQ(pane.dielectric->index_of_refraction, 1.5f);
  EXPECT_FLOAT_EQ(pane.dielectric->tint[0], 1.0f);
}

TEST_F(MitsubaMaterials, PlasticsAreCoatsOverABase) {
  const Material plastic =
      material(R"(<bsdf type="plastic"><rgb name="diffuse_reflectance" value="0.8"/>
      <float name="int_ior" value="1.5"/><float name="ext_ior" value="1"/>
      <boolean name="nonlinear" value="true"/></bsdf>)");
  ASSERT_TRUE(plastic.coat);
  EXPECT_FLOAT_EQ(plastic.coat->index_of_refraction, 1.5f);
  EXPECT_FLOAT_EQ(plastic.reflectance[0],
                  CoatOverBase(plastic).reflectance(Spectrum::Constant(3, 0.8f))[0]);
  EXPECT_FLOAT_EQ(plastic.specular_roughness, 0.0f);
  const Material rough = material(R"(<bsdf type="roughplastic"><float name="alpha" value="0.3"/>
      <rgb name="specular_reflectance" value="0.5"/></bsdf>)");
  ASSERT_TRUE(rough.coat);
  EXPECT_FLOAT_EQ(rough.specular_roughness, 0.3f);
  EXPECT_FLOAT_EQ(rough.specular[0], 0.5f);
}

// Base and coat together for even light, less the light mirrored by the coat, from 30 000 samples
// of Mitsuba 3.6's BSDF at angles of even light. Its standard error is at most 0.0008, of
// which three are allowed. Mitsuba sums F_i over 64 cosines including 0 and 1, which makes F_i less
// by up to 1/64 of itself and 1 / (1 - F_i) by up to F_i / (1 - F_i) / 64. F_i is below 0.596, that
// of a smooth coat: 0.0231 at most.
TEST_F(MitsubaMaterials, RoughPlasticsLoseWhatFacetsScatterTwice) {
  struct Known {
    const char* facets;
    double alpha, base;
    bool nonlinear;
    double reflected;
  };
  for (const Known& known :
       {Known{"ggx", 0.1, 1, false, 0.8273}, Known{"ggx", 0.1, 0.6, true, 0.3322},
        Known{"ggx", 0.2, 1, false, 0.7221}, Known{"ggx", 0.2, 0.6, true, 0.3141},
        Known{"ggx", 0.4, 1, false, 0.5415}, Known{"ggx", 0.4, 0.6, true, 0.2677},
        Known{"beckmann", 0.1, 1, false, 0.8803}, Known{"beckmann", 0.1, 0.6, true, 0.3408},
        Known{"beckmann", 0.2, 1, false, 0.8486}, Known{"beckmann", 0.2, 0.6, true, 0.3372},
        Known{"beckmann", 0.4, 1, false, 0.7370}, Known{"beckmann", 0.4, 0.6, true, 0.3205}}) {
    const Material rough = material(fmt::format(
        R"(<bsdf type="roughplastic"><float name="alpha" value="{}"/>
        <string name="distribution" value="{}"/><float name="int_ior" value="1.5"/>
        <float name="ext_ior" value="1"/><boolean name="nonlinear" value="{}"/>
        <rgb name="diffuse_reflectance" value="{}"/></bsdf>)",
        known.alpha, known.facets, known.nonlinear, known.base));
    EXPECT_NEAR(rough.reflectance[0], known.reflected, 3.0 * 0.0008 + 0.0231 * known.reflected)
        << known.facets << ' ' << known.alpha;
  }
}

// The light passes the coating's body of sigma 0.5 and thickness 0.2 twice.
// White below nearly smooth coats, where the integrals of the loss are off by as much as is lost.
// The bound is the rounding of the check of pictures.
TEST_F(MitsubaMaterials, RoughPlasticsSendBackNoMoreThanArrives) {
  for (const char* distribution : {"ggx", "beckmann"}) {
    for (const double alpha : {0.002, 0.01, 0.03, 0.1}) {
      const Material white =
          material(fmt::format(R"(<bsdf type="roughplastic"><float name="alpha" value="{}"/>
            <string name="distribution" value="{}"/><boolean name="nonlinear" value="true"/>
            <rgb name="diffuse_reflectance" value="1, 1, 1"/></bsdf>)",
                               alpha, distribution));
      EXPECT_LE(mean_sent_on(white).maxCoeff(), 1.0f + 1e-5f) << distribution << ", " << alpha;
      EXPECT_GT(mean_sent_on(white).minCoeff(), 0.9f) << distribution << ", " << alpha;
    }
  }
}

TEST_F(MitsubaMaterials, CoatingsCoverDiffuseSurfaces) {
  const Material varnish = material(R"(<bsdf type="roughcoating"><float name="alpha" value="0.2"/>
      <float name="int_ior" value="1.6"/><float name="ext_ior" value="1"/>
      <float name="thickness" value="0.2"/><rgb name="sigma_a" value="0.5"/>
      <bsdf type="diffuse"><rgb name="reflectance" value="0.6"/></bsdf></bsdf>)");
  ASSERT_TRUE(varnish.coat);
  EXPECT_FLOAT_EQ(varnish.coat->index_of_refraction, 1.6f);
  EXPECT_FLOAT_EQ(varnish.specular_roughness, 0.2f);
  const auto base = static_cast<float>(0.6 * std::exp(-0.2));
  EXPECT_FLOAT_EQ(varnish.reflectance[0],
                  CoatOverBase(varnish).reflectance(Spectrum::Constant(3, base))[0]);
  const Material gold = material(R"(<bsdf type="coating"><bsdf type="conductor">
      <string name="material" value="none"/></bsdf></bsdf>)");
  EXPECT_FALSE(gold.coat);
  EXPECT_FLOAT_EQ(gold.specular[0], 1.0f);
}

TEST_F(MitsubaMaterials, BlendsKeepTheBrighterGloss) {
  const std::string plastic =
      R"(<bsdf type="plastic"><rgb name="diffuse_reflectance" value="0.8"/></bsdf>)";
  const Material alone = material(plastic);
  const Material twice = material(R"(<bsdf type="blendbsdf"><float name="weight" value="0.5"/>)" +
                                  plastic + plastic + "</bsdf>");
  ASSERT_TRUE(twice.coat);
  EXPECT_FLOAT_EQ(twice.reflectance[0], alone.reflectance[0]);
  EXPECT_FLOAT_EQ(twice.specular[0], 1.0f);
  const Material with_metal = material(
      R"(<bsdf type="blendbsdf"><float name="weight" value="0.5"/><bsdf type="conductor">
      <string name="material" value="none"/></bsdf>)" +
      plastic + "</bsdf>");
  EXPECT_FALSE(with_metal.coat);
  EXPECT_FLOAT_EQ(with_metal.specular[0], 0.5f);
}

TEST_F(MitsubaMaterials, HighlightsOfPhongAndWardAreKept) {
  const Material phong =
      material(R"(<bsdf type="phong"><rgb name="diffuse_reflectance" value="0.5"/>
      <rgb name="specular_reflectance" value="0.2"/><float name="exponent" value="198"/></bsdf>)");
  EXPECT_FLOAT_EQ(phong.specular[0], 0.2f);
  EXPECT_FLOAT_EQ(phong.specular_roughness, 0.1f);
  const Material ward = material(R"(<bsdf type="ward"><rgb name="diffuse_reflectance" value="0.9"/>
      <rgb name="specular_reflectance" value="0.2"/><float name="alpha_u" value="0.15"/>
      <float name="alpha_v" value="0.05"/></bsdf>)");
  EXPECT_FLOAT_EQ(ward.specular[0], 0.1f);  // what the diffuse share leaves
  EXPECT_FLOAT_EQ(ward.specular_roughness, 0.15f);
}

// The default `specular` of 0.5 stands for a reflectance of 0.04 at normal incidence, index 1.5.
TEST_F(MitsubaMaterials, PrincipledDielectricsHaveACoat) {
  const Material wood = material(R"(<bsdf type="principled"><rgb name="base_color" value="0.5"/>
      <float name="roughness" value="0.4"/></bsdf>)");
  ASSERT_TRUE(wood.coat);
  EXPECT_NEAR(wood.coat->index_of_refraction, 1.5, 1e-6);
  EXPECT_FLOAT_EQ(wood.specular_roughness, 0.16f);
  EXPECT_FALSE(material(R"(<bsdf type="principled"><float name="metallic" value="1"/>
      <float name="roughness" value="0.4"/></bsdf>)")
                   .coat);
}

TEST_F(MitsubaMaterials, ColoursComeInEveryForm) {
  const auto reflectance = [&](const std::string& value) {
    return material("<bsdf type=\"diffuse\">" + value + "</bsdf>").reflectance;
  };
  EXPECT_FLOAT_EQ(reflectance(R"(<rgb name="reflectance" value="0.1, 0.2 0.3"/>)")[2], 0.3f);
  EXPECT_FLOAT_EQ(reflectance(R"(<spectrum name="reflectance" value="0.4"/>)")[1], 0.4f);
  EXPECT_FLOAT_EQ(reflectance(R"(<float name="reflectance" value="0.25"/>)")[0], 0.25f);
  // 128/255 = 0.50196 -> 0.21586 (IEC 61966-2-1).
  EXPECT_NEAR(reflectance(R"(<srgb name="reflectance" value="#8000ff"/>)")[0], 0.21586, 1e-5);
  // A ramp from 0 at 400 nm to 0.6 at 700 nm: means over 600-700, 500-600 and 400-500 nm.
  const Spectrum ramp = reflectance(R"(<spectrum name="reflectance" value="400:0, 700:0.6"/>)");
  EXPECT_NEAR(ramp[0], 0.5, 1e-6);
  EXPECT_NEAR(ramp[1], 0.3, 1e-6);
  EXPECT_NEAR(ramp[2], 0.1, 1e-6);
  const Spectrum checks = reflectance(R"(<texture type="checkerboard" name="reflectance">
      <rgb name="color0" value="0.2"/><rgb name="color1" value="0.6"/></texture>)");
  EXPECT_FLOAT_EQ(checks[0], 0.4f);
}

TEST_F(MitsubaMaterials, PicturesBecomeTheirMeanColour) {
  std::filesystem::copy(LIGHTWELL_TEST_DATA "/scene/two-pixels.png", folder / "my picture.png");
  const std::string picture = R"(<texture type="bitmap" name="reflectance">
      <string name="filename" value="my picture.png"/></texture>)";
  const std::string opacity = R"(<texture type="bitmap" name="opacity">
      <string name="filename" value="my picture.png"/></texture>)";
  EXPECT_FLOAT_EQ(material("<bsdf type='diffuse'>" + picture + "</bsdf>").reflectance[0], 0.5f);
  // A mask cuts away the black, transparent half.
  EXPECT_FLOAT_EQ(material("<bsdf type='mask'>" + opacity + "<bsdf type='diffuse'>" + picture +
                           "</bsdf></bsdf>")
                      .reflectance[0],
                  1.0f);
}

TEST_F(MitsubaMaterials, NormalAndBumpMapsAreRelief) {
  for (const char* name : {"normals.png", "heights.png"}) {
    std::filesystem::copy(std::filesystem::path(LIGHTWELL_TEST_DATA "/scene") / name,
                          folder / name);
  }
  const auto relief = [&](const std::string& plugin, const std::string& picture,
                          const std::string& more = "") {
    return material("<bsdf type='" + plugin + "'><texture type='bitmap' name='t'><string " +
                    "name='filename' value='" + picture + "'/><boolean name='raw' value='true'/>" +
                    "</texture>" + more + "<bsdf type='diffuse'/></bsdf>")
        .relief;
  };
  const auto normals = relief("normalmap", "normals.png");
  ASSERT_TRUE(normals);
  EXPECT_NEAR(normals->steepest, 76.0 / 102.0, 1e-4);
  const auto heights = relief("bumpmap", "heights.png", "<float name='scale' value='0.02'/>");
  ASSERT_TRUE(heights);
  EXPECT_TRUE(heights->is_in_metres);
  EXPECT_EQ(heights->scale, 0.02);
  EXPECT_FALSE(relief("normalmap", "heights.png"));
  EXPECT_FALSE(relief("bumpmap", "gone.png"));
}

TEST_F(MitsubaMaterials, ConductorsReflectByAngle) {
  const Material metal = material(
      "<bsdf type='roughconductor'><rgb name='eta' value='0.2, 0.9, 1.1'/><rgb name='k' "
      "value='3.9, "
      "2.5, 2.1'/><rgb name='specular_reflectance' value='0.5'/></bsdf>");
  ASSERT_TRUE(metal.metal);
  EXPECT_FLOAT_EQ(metal.metal->k[2], 2.1f);
  EXPECT_FLOAT_EQ(metal.specular[0], 0.5f);
  EXPECT_FLOAT_EQ(metal.specular_roughness, 0.1f);
}

TEST_F(MitsubaMaterials, AMaskCutsOnlyWhereItIs) {
  std::filesystem::copy(LIGHTWELL_TEST_DATA "/scene/two-pixels.png", folder / "leaf.png");
  const std::string leaf = R"(<bsdf type="diffuse" id="leaf"><texture type="bitmap"
      name="reflectance"><string name="filename" value="leaf.png"/></texture></bsdf>)";
  const std::string masked =
      R"(<shape type="cube"><bsdf type="mask"><texture type="bitmap" name="opacity">
      <string name="filename" value="leaf.png"/></texture><ref id="leaf"/></bsdf></shape>)";
  const std::string whole = R"(<shape type="cube"><ref id="leaf"/></shape>)";
  const auto reflectance = [](const Scene& scene, std::size_t surface) {
    const auto m = static_cast<std::size_t>(scene.surfaces.at(surface).material);
    return scene.materials.at(m).reflectance[0];
  };
  const Scene one_way = read(leaf + masked + whole), other_way = read(leaf + whole + masked);
  EXPECT_FLOAT_EQ(reflectance(one_way, 0), 1.0f);
  EXPECT_FLOAT_EQ(reflectance(one_way, 1), 0.5f);
  EXPECT_FLOAT_EQ(reflectance(other_way, 0), 0.5f);
  EXPECT_FLOAT_EQ(reflectance(other_way, 1), 1.0f);
}

// With an opacity of 0.6, 0.6 of the plastic stays and 0.4 of the light passes straight on.
TEST_F(MitsubaMaterials, AMaskOfAnEvenOpacityLetsTheRestThrough) {
  const std::string plastic =
      R"(<bsdf type="plastic"><rgb name="diffuse_reflectance" value="0.5"/></bsdf>)";
  const Material whole = material(plastic);
  const auto masked = [&](const std::string& opacity, const std::string& inner) {
    return material("<bsdf type='mask'>" + opacity + inner + "</bsdf>");
  };
  const Material gauze = masked("<float name='opacity' value='0.6'/>", plastic);
  EXPECT_FLOAT_EQ(gauze.reflectance[0], 0.6f * whole.reflectance[0]);
  EXPECT_FLOAT_EQ(gauze.specular[0], 0.6f);
  EXPECT_FLOAT_EQ(gauze.regular_transmittance[0], 0.4f);
  EXPECT_FALSE(gauze.one_sided || gauze.mask);
  EXPECT_FLOAT_EQ(masked("", plastic).regular_transmittance[0], 0.5f);  // Mitsuba's default
  const Material tinted = masked("<rgb name='opacity' value='0.25, 0.5, 1'/>", plastic);
  EXPECT_FLOAT_EQ(tinted.regular_transmittance[0], 0.75f);
  EXPECT_FLOAT_EQ(tinted.regular_transmittance[2], 0.0f);
  const std::string half = "<float name='opacity' value='0.5'/>";
  EXPECT_TRUE(masked(half, "<bsdf type='dielectric'/>").dielectric);
  const Scene lamp = read("<shape type='rectangle'><bsdf type='mask'>" + half + plastic +
                          "</bsdf><emitter type='area'/></shape>");
  EXPECT_FALSE(first_material(lamp).passes_straight());
  EXPECT_TRUE(has_loss(lamp, "Lamps let no light straight through"));
}

// Two texels of alpha 0.2 and 0.6: neither clear nor opaque.
TEST_F(MitsubaMaterials, APictureOfGauzeIsAMaskOfItsMeanOpacity) {
  std::filesystem::copy(LIGHTWELL_TEST_DATA "/scene/gauze.png", folder / "gauze.png");
  const Material gauze = material(R"(<bsdf type="mask"><texture type="bitmap" name="opacity">
      <string name="filename" value="gauze.png"/></texture><bsdf type="diffuse"/></bsdf>)");
  EXPECT_FALSE(gauze.mask);
  // Texels have 16 bits, of the square root: steps of 2e-5 here.
  EXPECT_NEAR(gauze.regular_transmittance[0], 0.6f, 2e-5f);
}

TEST_F(MitsubaMaterials, DiffuseTransmittersPassTheirTransmittance) {
  const Material paper = material(
      R"(<bsdf type="difftrans"><rgb name="transmittance" value="0.6, 0.5, 0.4"/></bsdf>)");
  EXPECT_FLOAT_EQ(paper.transmittance[0], 0.6f);
  EXPECT_FLOAT_EQ(paper.transmittance[2], 0.4f);
  EXPECT_FALSE((paper.reflectance > 0.0f).any() || paper.one_sided);
  EXPECT_FLOAT_EQ(material(R"(<bsdf type="difftrans"/>)").transmittance[0], 0.5f);
  const Material both = material(R"(<bsdf type="twosided"><bsdf type="difftrans"/></bsdf>)");
  EXPECT_FLOAT_EQ(both.transmittance[0], 0.5f);
}

// A leaf: 0.7 of its mixture reflects 0.4, and 0.3 passes 0.5.
TEST_F(MitsubaMaterials, BlendsPassTheMeanOfTheirParts) {
  const Material leaf = material(R"(<bsdf type="blendbsdf"><float name="weight" value="0.3"/>
      <bsdf type="diffuse"><rgb name="reflectance" value="0.4"/></bsdf>
      <bsdf type="difftrans"/></bsdf>)");
  EXPECT_FLOAT_EQ(leaf.reflectance[0], 0.7f * 0.4f);
  EXPECT_FLOAT_EQ(leaf.transmittance[0], 0.3f * 0.5f);
  const Material net = material(R"(<bsdf type="blendbsdf"><float name="weight" value="0.75"/>
      <bsdf type="diffuse"><rgb name="reflectance" value="0.4"/></bsdf>
      <bsdf type="null"/></bsdf>)");
  EXPECT_FLOAT_EQ(net.reflectance[0], 0.1f);
  EXPECT_FLOAT_EQ(net.regular_transmittance[0], 0.75f);
  // Weights of 2 in all: everything that arrives leaves, as much to either side.
  const Material twice = material(R"(<bsdf type="mixturebsdf"><string name="weights" value="1, 1"/>
      <bsdf type="diffuse"><rgb name="reflectance" value="1"/></bsdf>
      <bsdf type="difftrans"><rgb name="transmittance" value="1"/></bsdf></bsdf>)");
  EXPECT_FLOAT_EQ(twice.reflectance[0], 0.5f);
  EXPECT_FLOAT_EQ(twice.transmittance[0], 0.5f);
}

TEST_F(MitsubaMaterials, ANullBsdfLetsAllLightThrough) {
  const Material null = material(R"(<bsdf type="null"/>)");
  EXPECT_FLOAT_EQ(null.regular_transmittance[0], 1.0f);
  EXPECT_FALSE(null.dielectric || null.is_diffuse());
}

// The light passes the coating's body once on either side, as reflected light passes it twice.
TEST_F(MitsubaMaterials, CoatingsCoverBothSidesOfASheet) {
  const Material opal = material(R"(<bsdf type="coating"><float name="thickness" value="0.2"/>
      <rgb name="sigma_a" value="0.5"/><bsdf type="difftrans"/></bsdf>)");
  const auto tau = static_cast<float>(0.5 * std::exp(-0.2));
  const CoatOverBase coat(opal);
  EXPECT_FLOAT_EQ(opal.transmittance[0], 0.5f * (coat.reflectance(Spectrum::Constant(3, tau))[0] -
                                                 coat.reflectance(Spectrum::Constant(3, -tau))[0]));
  EXPECT_TRUE(opal.coat);
}

TEST_F(MitsubaMaterials, TexturesThatShareTheirPartsAreReadOnce) {
  // Without sharing, these would be 2^32 checkerboards.
  std::string boards = R"(<texture type="checkerboard" id="t0"/>)";
  for (int i = 1; i < 32; ++i) {
    boards += "<texture type='checkerboard' id='t" + std::to_string(i) + "'>";
    for (const char* color : {"color0", "color1"}) {
      boards += std::string("<ref name='") + color + "' id='t" + std::to_string(i - 1) + "'/>";
    }
    boards += "</texture>";
  }
  const Scene scene = read(boards + R"(<shape type="cube"><bsdf type="diffuse">
      <ref name="reflectance" id="t31"/></bsdf></shape>)");
  EXPECT_FLOAT_EQ(scene.materials.at(0).reflectance[0], 0.3f);  // mean of the defaults, 0.4 and 0.2
}

TEST_F(MitsubaMaterials, TexturesOfANumberCountByTheirMean) {
  const auto metal = [&](const std::string& alpha) {
    return material("<bsdf type='roughconductor'>" + alpha + "</bsdf>").specular[0] > 0.0f;
  };
  const auto checks = [](const char* name, const char* color) {
    return std::string("<texture type='checkerboard' name='") + name + "'><float name='color0' " +
           "value='0'/><float name='color1' value='" + color + "'/></texture>";
  };
  EXPECT_TRUE(metal(""));  // alpha 0.1
  EXPECT_TRUE(metal(checks("alpha", "0.9")));
  EXPECT_TRUE(metal(checks("alpha", "1.1")));  // cut off at 1, so that the mean is 0.5
  EXPECT_TRUE(metal("<spectrum name='alpha' value='0.45'/>"));
  EXPECT_FALSE(metal("<spectrum name='alpha' value='0.55'/>"));
  const auto principled = [&](const std::string& parts) {
    return material("<bsdf type='principled'>" + parts + "</bsdf>");
  };
  EXPECT_TRUE(principled(checks("spec_trans", "1")).dielectric.has_value());
  EXPECT_FALSE(principled(checks("spec_trans", "0.9")).dielectric.has_value());
  const std::string polished = "<float name='roughness' value='0.1'/>";
  const Material half = principled(checks("metallic", "1") + polished);
  ASSERT_TRUE(half.coat);
  EXPECT_FLOAT_EQ(half.coat->bare[0], 0.5f * 0.5f);
}

TEST_F(MitsubaMaterials, AThinPrincipledSheetIsAPane) {
  const Material pane = material(R"(<bsdf type="principledthin">
      <rgb name="base_color" value="0.8"/><float name="spec_trans" value="1"/></bsdf>)");
  ASSERT_TRUE(pane.dielectric.has_value());
  EXPECT_TRUE(pane.dielectric->thin);
  EXPECT_FLOAT_EQ(pane.dielectric->tint[0], 0.8f);
  EXPECT_FLOAT_EQ(pane.dielectric->roughness, 0.25f);  // the square of Mitsuba's default
  const Material block = material(R"(<bsdf type="principled"><string name="eta" value="diamond"/>
      <float name="spec_trans" value="1"/></bsdf>)");
  EXPECT_FLOAT_EQ(block.dielectric.value().index_of_refraction, 2.419f);
}

// A diff_trans of 2 would pass all diffuse light. The default roughness 0.5 is an alpha of 0.25.
TEST_F(MitsubaMaterials, AThinPrincipledSheetPassesLight) {
  const auto sheet = [&](const std::string& keys) {
    return material(R"(<bsdf type="principledthin"><rgb name="base_color" value="0.8"/>)" + keys +
                    "</bsdf>");
  };
  const std::string matt = R"(<float name="roughness" value="1"/>)";
  const Material paper = sheet(matt + R"(<float name="diff_trans" value="0.5"/>)");
  EXPECT_FLOAT_EQ(paper.reflectance[0], 0.8f * 0.75f);
  EXPECT_FLOAT_EQ(paper.transmittance[0], 0.8f * 0.25f);
  EXPECT_FALSE(paper.passes_straight());
  const std::string part =
      R"(<float name="diff_trans" value="1"/><float name="spec_trans" value="0.6"/>)";
  const Material frosted = sheet(matt + part);
  EXPECT_FLOAT_EQ(frosted.reflectance[0], 0.8f * 0.4f * 0.5f);
  EXPECT_FLOAT_EQ(frosted.transmittance[0], 0.8f * (0.4f * 0.5f + 0.6f));
  const Material foil = sheet(R"(<float name="roughness" value="0.1"/>)" + part);
  ASSERT_TRUE(foil.coat);
  const auto kept = static_cast<float>(1.0 - CoatedBase(foil).mean_mirrored());
  EXPECT_FLOAT_EQ(foil.regular_transmittance[0], kept * 0.8f * 0.6f);
  EXPECT_FLOAT_EQ(foil.transmittance[0], kept * 0.8f * 0.2f);
}

}  // namespace
}  // namespace lightwell::mitsuba_materials_test
