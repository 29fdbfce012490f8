#pragma once

#include <Eigen/Core>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace lightwell::test {

/// Two polygons, what stands between them, and F_12.
struct ViewFactorCase {
  std::string name;
  std::vector<Eigen::Vector3d> first, second;
  std::vector<std::vector<Eigen::Vector3d>> blockers;
  double F12;
};

inline std::vector<ViewFactorCase> view_factor_cases() {
  const auto polygon = [](const nlohmann::json& points) {
    std::vector<Eigen::Vector3d> loop;
    for (const auto& p : points) {
      loop.push_back(Eigen::Vector3d(p[0].get<double>(), p[1].get<double>(), p[2].get<double>()));
    }
    return loop;
  };
  std::ifstream file(LIGHTWELL_TEST_DATA "/radiosity/view_factors.json");
  std::vector<ViewFactorCase> cases;
  const nlohmann::json all = nlohmann::json::parse(file);
  for (const auto& c : all.at("cases")) {
    ViewFactorCase one{.name = c.at("name"),
                       .first = polygon(c.at("polygon1")),
                       .second = polygon(c.at("polygon2")),
                       .F12 = c.at("F12")};
    for (const auto& blocker : c.at("blockers")) one.blockers.push_back(polygon(blocker));
    cases.push_back(one);
  }
  return cases;
}

}  // namespace lightwell::test
