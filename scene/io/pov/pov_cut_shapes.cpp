#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "scene/errors.h"
#include "scene/io/convex_cut.h"
#include "scene/io/placed_mesh.h"
#include "scene/io/pov/pov_shapes.h"
#include "scene/io/pov/pov_transform.h"

namespace lightwell {
namespace {

constexpr std::size_t most_bodies = 200;

PovConvex placed_convex(const PovSolid& solid, const Eigen::Affine3d& to_world) {
  if (solid.pieces.size() != 1) return {};
  const auto* facets = std::get_if<PovFacets>(&solid.pieces[0].shape);
  if (!facets || !facets->polygons.empty()) return {};
  std::vector<Loop> faces = facets->loops;
  const bool is_mirrored = to_world.linear().determinant() < 0.0;
  for (Loop& face : faces) {
    for (Eigen::Vector3d& p : face) p = to_world * p;
    if (is_mirrored) std::ranges::reverse(face);
  }
  return pov_convex(std::move(faces));
}

bool is_operand(const PovNode& node) {
  const std::string_view word = node.keyword;
  return word != "texture" && word != "pigment" && word != "finish" && word != "normal" &&
         word != "interior" && word != "material" && word != "bounded_by" && word != "clipped_by" &&
         word != "photons" && word != "transform" && word != "interior_texture";
}

}  // namespace

// False for an operand that is no convex body with flat faces, nor a group of such bodies.
bool PovShapes::add_bodies(const PovNode& operand, const PovPlacement& outer,
                           std::vector<Body>& bodies) {
  count_pov_visit(operand, materials_.visits());
  if (bodies.size() >= most_bodies) {
    operand.fail(fmt::format("is beyond the {} bodies that may cut each other", most_bodies));
  }
  const std::string_view word = operand.keyword;
  PovCursor cursor(operand);
  if (word == "object" || word == "union" || word == "merge") {
    const PovPlacement placement = inner(cursor, outer);
    for (const PovItem& item : operand.items) {
      if (!item.node() || !is_operand(*item.node())) continue;
      if (!add_bodies(*item.node(), placement, bodies)) return false;
    }
    return true;
  }
  Body body;
  if (word == "plane") {
    const Eigen::Vector3d normal = cursor.need_point("normal");
    const double distance = cursor.need_number("distance");
    if (!(normal.stableNorm() > 0.0)) operand.fail("has a normal without length");
    body.placement = inner(cursor, outer);
    const Eigen::Affine3d& to_world = body.placement.to_world;
    const Eigen::Vector3d across = to_world.linear().inverse().transpose() * normal.normalized();
    if (!across.allFinite() || !(across.norm() > 0.0)) operand.fail("is scaled to nothing");
    PovHalfSpace half{.normal = across.normalized()};
    half.distance = half.normal.dot(to_world * (distance * normal.normalized()));
    if (body.placement.is_hollow) half = {.normal = -half.normal, .distance = -half.distance};
    body.unbounded.push_back(half);
    body.convex.planes.push_back(half);
  } else if (word == "box" || word == "prism") {
    const auto solid = read_pov_solid(cursor, remarks_);
    body.placement = inner(cursor, outer);
    if (!solid || body.placement.is_hollow) return false;
    body.convex = placed_convex(*solid, body.placement.to_world);
    if (body.convex.planes.empty()) return false;
  } else {
    return false;
  }
  bodies.push_back(std::move(body));
  return true;
}

// Gives half spaces a face that reaches beyond all bodies with bounds.
void PovShapes::bound_bodies(std::vector<Body>& bodies, double& size) const {
  Eigen::AlignedBox3d box;
  for (const Body& body : bodies) {
    for (const Loop& face : body.convex.faces) {
      for (const Eigen::Vector3d& p : face) box.extend(p);
    }
  }
  size = box.isEmpty() ? 0.0 : box.diagonal().norm();
  if (!(size > 0.0)) return;
  for (Body& body : bodies) {
    for (const PovHalfSpace& half : body.unbounded) {
      body.convex.faces = {
          plane_square({.half_space = half}, {.low = box.min(), .high = box.max()})};
    }
  }
}

void PovShapes::add_cut(const PovNode& block, const PovPlacement& outer) {
  PovCursor cursor(block);
  PovPlacement placement = inner(cursor, outer);
  const bool is_difference = block.keyword == "difference";
  const std::string label = placement.name.empty() ? block.label() : placement.name;
  std::vector<Body> bodies;
  std::size_t first_bodies = 0;
  for (const PovItem& item : block.items) {
    const PovNode* operand = item.node();
    if (!operand || !is_operand(*operand)) continue;
    const std::size_t before = bodies.size();
    const bool is_group = operand->keyword == "union" || operand->keyword == "merge";
    if (add_bodies(*operand, placement, bodies) && !(is_group && (before == 0 || !is_difference))) {
      if (before == 0) first_bodies = bodies.size();
      continue;
    }
    bodies.resize(before);
    if (!is_difference || before == 0) {
      return remarks_.add(
          fmt::format("Shapes of the kind '{}' were left out, but for those of convex bodies with "
                      "flat faces",
                      block.keyword),
          label);
    }
    remarks_.add(fmt::format("Bodies that are not convex with flat faces were not cut off in"),
                 label);
  }
  double size = 0.0;
  bound_bodies(bodies, size);
  if (bodies.empty() || !(size > 0.0) ||
      (is_difference && (first_bodies != 1 || !bodies[0].unbounded.empty()))) {
    return remarks_.add(
        fmt::format("Shapes of the kind '{}' that have no bounds were left out", block.keyword),
        label);
  }
  std::vector<PovConvex> convex;
  for (const Body& body : bodies) convex.push_back(body.convex);
  const std::vector<PovCutFace> faces =
      is_difference ? pov_difference(convex[0], {convex.begin() + 1, convex.end()}, size)
                    : pov_intersection(convex, size);
  bool is_there = false;
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    PovPiece piece;
    PovFacets facets;
    for (const PovCutFace& face : faces) {
      if (face.body == b) facets.loops.push_back(face.loop);
    }
    if (facets.loops.empty()) continue;
    is_there = true;
    piece.shape = std::move(facets);
    PovPlacement own = bodies[b].placement;
    own.to_world = Eigen::Affine3d::Identity();  // the faces are in the scene
    own.name = label;
    own.is_hollow = placement.is_hollow;
    add_piece(piece, own, true);
  }
  if (!is_there) remarks_.add("Shapes without area were left out", label);
}

}  // namespace lightwell
