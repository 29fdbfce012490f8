#include "design/luminaires.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "radiosity/solution/emitter_channels.h"
#include "scene/errors.h"
#include "scene/io/matches_glob.h"
#include "scene/io/nearest_name.h"
#include "scene/io/numbered_names.h"
#include "scene/lamp.h"
#include "scene/projected_picture.h"

namespace lightwell {
namespace {

/// A luminaire of a scene: a surface, or a lamp behind all surfaces.
struct Member {
  std::string name{}, shared_name{};
  int surface = -1, lamp = -1;  // one of them an index
};

std::vector<Member> members_of(const Scene& scene) {
  std::vector<Member> members;
  for (std::size_t s = 0; s < scene.surfaces.size(); ++s) {
    const Surface& surface = scene.surfaces[s];
    if (!scene.materials[static_cast<std::size_t>(surface.material)].is_emitter()) continue;
    members.push_back({.shared_name = surface.name, .surface = static_cast<int>(s)});
  }
  for (std::size_t i = 0; i < scene.lamps.size(); ++i) {
    members.push_back({.shared_name = scene.lamps[i].name, .lamp = static_cast<int>(i)});
  }
  std::map<std::string, int> count, number;
  for (const Member& member : members) ++count[member.shared_name];
  NumberedNames given;
  for (Member& member : members) {
    const std::string& shared = member.shared_name;
    member.name =
        given.unique(count[shared] > 1 ? fmt::format("{} {}", shared, ++number[shared]) : shared);
  }
  return members;
}

bool is_named(const std::string& name, const Member& member) {
  return name == member.name || name == member.shared_name;
}

bool stands_for(const std::string& name, const Member& member) {
  return matches_glob(name, member.name) || matches_glob(name, member.shared_name);
}

std::vector<std::string> names_of(const std::vector<Member>& members) {
  std::vector<std::string> names;
  for (const Member& member : members) {
    for (const std::string& name : {member.shared_name, member.name}) {
      if (std::ranges::find(names, name) == names.end()) names.push_back(name);
    }
  }
  return names;
}

// Group of each member; -1: none.
std::vector<int> groups_of(const std::vector<Member>& members,
                           std::span<const WordedGroup> groups) {
  std::vector<int> group_of(members.size(), -1);
  for (std::size_t g = 0; g < groups.size(); ++g) {
    for (const std::string& name : groups[g].names) {
      bool any = false;
      for (std::size_t i = 0; i < members.size(); ++i) {
        if (!stands_for(name, members[i])) continue;
        any = true;
        if (group_of[i] >= 0 && group_of[i] != static_cast<int>(g)) {
          throw InputError(fmt::format(
              "{} would dim '{}', which group {} dims already; leave it out of one of them",
              groups[g].origin, members[i].name, group_of[i] + 1));
        }
        group_of[i] = static_cast<int>(g);
      }
      if (!any) {
        throw InputError(fmt::format("{} names '{}', and there is no luminaire of that name.{}",
                                     groups[g].origin, name,
                                     did_you_mean(name, names_of(members))));
      }
    }
  }
  return group_of;
}

// Throws InputError unless the luminaire can be moved.
void require_movable(const Scene& scene, const Member& member, const WordedMove& move) {
  if (member.lamp < 0) {
    throw InputError(fmt::format(
        "{} names '{}', which is a surface, and only lamps are moved; give the luminaire as a "
        "[[lamps]] table with its photometric file, or leave it out",
        move.origin, member.name));
  }
  const Lamp& lamp = scene.lamps[static_cast<std::size_t>(member.lamp)];
  if (std::holds_alternative<SharedPicture>(lamp.shape)) {
    throw InputError(fmt::format(
        "{} names '{}', which projects a picture onto its place, and is not moved; leave it out",
        move.origin, member.name));
  }
}

// The box of a lamp, which must hold the lamp.
AllowedPlace allowed_place(const Scene& scene, const Member& member, const WordedMove& move) {
  const Eigen::Vector3d position = scene.lamps[static_cast<std::size_t>(member.lamp)].position;
  AllowedPlace place{.lamp = member.lamp,
                     .low = position,
                     .high = position,
                     .apart = move.apart * scene.metres_per_unit};
  for (std::size_t i = 0; i < move.axes.size(); ++i) {
    const int axis = move.axes[i];
    place.low[axis] = move.lowest[i] * scene.metres_per_unit;
    place.high[axis] = move.highest[i] * scene.metres_per_unit;
    if (position[axis] >= place.low[axis] - place_tolerance &&
        position[axis] <= place.high[axis] + place_tolerance) {
      continue;
    }
    throw InputError(fmt::format(
        "{} lets '{}' move from {} = {:g} to {:g}, and the scene has it at {:g}; widen the box, or "
        "move the luminaire into it",
        move.origin, member.name, static_cast<char>('x' + axis), move.lowest[i], move.highest[i],
        position[axis] / scene.metres_per_unit));
  }
  return place;
}

}  // namespace

AllowedPlaces allowed_places(const Scene& scene, std::span<const WordedMove> moves) {
  const std::vector<Member> members = members_of(scene);
  AllowedPlaces allowed;
  std::vector<std::string> origin_of_lamp(scene.lamps.size());
  for (const WordedMove& move : moves) {
    for (const std::string& name : move.names) {
      bool any = false;
      for (const Member& member : members) {
        if (!stands_for(name, member)) continue;
        any = true;
        require_movable(scene, member, move);
        std::string& origin = origin_of_lamp[static_cast<std::size_t>(member.lamp)];
        if (origin == move.origin) continue;
        if (!origin.empty()) {
          throw InputError(
              fmt::format("{} would move '{}', as {} does; leave it out of one of them",
                          move.origin, member.name, origin));
        }
        origin = move.origin;
        allowed.moved.push_back(allowed_place(scene, member, move));
      }
      if (!any) {
        throw InputError(fmt::format("{} names '{}', and there is no luminaire of that name.{}",
                                     move.origin, name, did_you_mean(name, names_of(members))));
      }
    }
  }
  for (std::size_t i = 0; i < scene.lamps.size(); ++i) {
    if (origin_of_lamp[i].empty()) allowed.fixed.push_back(scene.lamps[i].position);
  }
  if (!allowed.moved.empty() && !allows(allowed, places_of(scene, allowed))) {
    throw InputError(fmt::format(
        "{}: lamps are closer to each other than 'apart' allows; make that distance smaller, or "
        "part the lamps in the scene",
        moves.front().origin));
  }
  return allowed;
}

EmitterChannels dimming_channels(const Scene& scene, std::span<const WordedGroup> groups) {
  const std::vector<Member> members = members_of(scene);
  const std::vector<int> group_of = groups_of(members, groups);
  EmitterChannels channels{.of_surface = std::vector<int>(scene.surfaces.size(), -1),
                           .of_source = std::vector<int>(scene.lamps.size(), -1)};
  NumberedNames given;
  const auto add = [&](const std::string& name) {
    channels.names.push_back(given.unique(name));
    return static_cast<int>(channels.names.size()) - 1;
  };
  std::map<int, int> channel_of_group;
  for (std::size_t i = 0; i < members.size(); ++i) {
    const int group = group_of[i];
    int channel = 0;
    if (group < 0) {
      channel = add(members[i].name);
    } else if (const auto at = channel_of_group.find(group); at != channel_of_group.end()) {
      channel = at->second;
    } else {
      const auto& names = groups[static_cast<std::size_t>(group)].names;
      channel = channel_of_group[group] = add(names.size() == 1   ? names.front()
                                              : names.size() == 2 ? names[0] + " + " + names[1]
                                                                  : names.front() + " + others");
    }
    if (members[i].surface >= 0) {
      channels.of_surface[static_cast<std::size_t>(members[i].surface)] = channel;
    } else {
      channels.of_source[static_cast<std::size_t>(members[i].lamp)] = channel;
    }
  }
  for (int i = static_cast<int>(scene.lamps.size()); i < free_source_count(scene); ++i) {
    channels.of_source.push_back(add(free_source_name(scene, i)));
  }
  if (channels.names.size() > most_channels) {
    throw InputError(fmt::format(
        "{}: {} luminaires would be dimmed each by itself, and at most {} levels are possible; put "
        "luminaires that dim together into groups of [dimming]",
        scene.file.string(), channels.names.size(), most_channels));
  }
  return channels;
}

void require_luminaires(const Scene& scene, std::span<const NamedNumber> watts) {
  const std::vector<Member> members = members_of(scene);
  if (members.empty()) {
    throw InputError(
        fmt::format("{}: there is no luminaire to dim; add [[lamps]], or surfaces that emit light",
                    scene.file.string()));
  }
  for (const NamedNumber& known : watts) {
    if (std::ranges::any_of(members, [&](const Member& m) { return is_named(known.name, m); })) {
      continue;
    }
    throw InputError(fmt::format("{}: there is no luminaire '{}', whose power is given.{}",
                                 scene.file.string(), known.name,
                                 did_you_mean(known.name, names_of(members))));
  }
}

std::vector<Luminaire> luminaires_of(const Scene& scene, const SolvedScene& solved,
                                     const LightingDesign& design,
                                     std::span<const NamedNumber> watts) {
  const std::vector<Member> members = members_of(scene);
  const PatchMesh& mesh = solved.mesh;
  const RadiositySolution& solution = solved.solution;
  std::vector<Luminaire> luminaires;
  std::vector<std::size_t> of_surface(scene.surfaces.size(), members.size());
  std::vector<double> area(members.size(), 0.0);
  for (const Member& member : members) {
    Luminaire made{.name = member.name, .shared_name = member.shared_name};
    if (member.surface >= 0) {
      of_surface[static_cast<std::size_t>(member.surface)] = luminaires.size();
    } else {
      const auto i = static_cast<std::size_t>(member.lamp);
      const Lamp& lamp = scene.lamps[i];
      made.position = lamp.position;
      made.lumens = luminous(scene.bands, lamp_flux(lamp));
      made.channel = solution.source_channel[i];
      if (i < design.watts.size()) made.watts = design.watts[i];
    }
    luminaires.push_back(std::move(made));
  }
  for (int p = 0; p < mesh.patch_count(); ++p) {
    const std::size_t i = of_surface[static_cast<std::size_t>(mesh.surface[p])];
    // The back of a surface that emits from its front is in no channel.
    const bool emits = (solution.full_emission.row(p) > 0.0f).any();
    if (i == members.size() || !emits) continue;
    Luminaire& luminaire = luminaires[i];
    luminaire.lumens +=
        mesh.area[p] * luminous(scene.bands, solution.full_emission.row(p).transpose());
    const int channel = solution.patch_channel[static_cast<std::size_t>(p)];
    if (channel < 0 || (luminaire.channel >= 0 && luminaire.channel != channel)) {
      throw InputError(fmt::format(
          "luminaire '{}' {} of the solution; solve with --channels per-luminaire, or leave the "
          "solution out",
          luminaire.name, channel < 0 ? "is in no channel" : "is in several channels"));
    }
    luminaire.channel = channel;
  }
  for (int e = 0; e < mesh.element_count(); ++e) {
    const std::size_t i = of_surface[static_cast<std::size_t>(mesh.surface[mesh.patch[e]])];
    if (i == members.size()) continue;
    luminaires[i].position += mesh.element_area[e] * element_center(mesh, e).position;
    area[i] += mesh.element_area[e];
  }
  for (std::size_t i = 0; i < luminaires.size(); ++i) {
    if (area[i] > 0.0) luminaires[i].position /= area[i];
  }
  for (const NamedNumber& known : watts) {
    for (std::size_t i = 0; i < luminaires.size(); ++i) {
      if (is_named(known.name, members[i])) luminaires[i].watts = known.value;
    }
  }
  std::erase_if(luminaires, [](const Luminaire& made) { return made.channel < 0; });
  return luminaires;
}

}  // namespace lightwell
