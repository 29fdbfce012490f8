#!/usr/bin/env python3
"""The truth of bounds_bench by the path tracer of Mitsuba 3.

  PYTHON bench/bounds_mitsuba.py ROOM.csv... [--samples N]

PYTHON is a Python 3.11 with Mitsuba 3 and numpy (PyPI: mitsuba, numpy). ROOM.csv are rooms that bounds_bench wrote to the folder
LIGHTWELL_ROOMS. At each place in no gap (Mitsuba moves the origins of rays by more than narrow gaps are wide) a ray looks straight down
at the surface, and E = pi L / rho. ROOM.csv.truth gets the illuminance of each place and its standard error, in gaps those of
bounds_bench. Printed per room: the mean ratio of both path tracers, and the RMS difference in standard errors of the difference, which is
1 if both agree.
"""
import argparse
import os

import mitsuba as mi
import numpy as np

LUMENS = 683.0


def read_room(path):
    materials, faces, places = [], [], []
    for line in open(path):
        kind, *cells = line.strip().split(",")
        values = [float(cell) for cell in cells]
        if kind == "material":
            materials.append(values)
        elif kind == "face":
            faces.append((int(values[0]), np.array(values[1:]).reshape(-1, 3)))
        else:
            places.append(values)
    return materials, faces, np.array(places)


def mitsuba_scene(materials, faces):
    scene = {"type": "scene"}
    for number, (reflectance, emission) in enumerate(materials):
        mine = [corners for material, corners in faces if material == number]
        properties = mi.Properties()
        properties["bsdf"] = mi.load_dict({"type": "diffuse", "reflectance": {"type": "rgb", "value": [reflectance] * 3}})
        if emission > 0:
            radiance = {"type": "rgb", "value": [emission / np.pi] * 3}
            properties["emitter"] = mi.load_dict({"type": "area", "radiance": radiance})
        mesh = mi.Mesh(f"m{number}", 4 * len(mine), 2 * len(mine), props=properties)
        parameters = mi.traverse(mesh)
        parameters["vertex_positions"] = np.ravel(np.concatenate(mine)).astype(np.float32)
        indices = [[4 * i + a for a in t] for i in range(len(mine)) for t in ([0, 1, 2], [0, 2, 3])]
        parameters["faces"] = np.ravel(np.array(indices, dtype=np.uint32))
        parameters.update()
        scene[f"m{number}"] = mesh
    return mi.load_dict(scene)


def irradiance(scene, places, size, samples):
    """Illuminance and its standard error at the places, by independent sets of samples."""
    height, sets = 2e-4 * size, 8
    integrator = mi.load_dict({"type": "path", "max_depth": -1, "rr_depth": 5})
    found = []
    for place in places:
        start, down = place[:3] + height * place[3:6], -place[3:6]
        hit = scene.ray_intersect(mi.Ray3f(mi.Point3f(*start), mi.Vector3f(*down)))
        reflectance = np.ravel(hit.bsdf().eval_diffuse_reflectance(hit))[0]
        film = {"type": "hdrfilm", "width": 1, "height": 1, "pixel_format": "rgb", "component_format": "float32", "rfilter": {"type": "box"}}
        meter = mi.load_dict({"type": "radiancemeter", "origin": list(start), "direction": list(down), "film": film,
                              "sampler": {"type": "independent", "sample_count": samples}})
        radiance = [np.ravel(mi.render(scene, sensor=meter, integrator=integrator, spp=samples, seed=number + 1))[1] for number in range(sets)]
        found.append(LUMENS * np.pi * np.array(radiance) / reflectance)
    found = np.array(found)
    return found.mean(1), found.std(1, ddof=1) / np.sqrt(sets)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("rooms", nargs="+")
    parser.add_argument("--samples", type=int, default=32768)
    arguments = parser.parse_args()
    mi.set_variant(os.environ.get("MITSUBA_VARIANT", "scalar_rgb"))
    for path in arguments.rooms:
        materials, faces, places = read_room(path)
        size = np.ptp(np.concatenate([corners for _, corners in faces]), axis=0).max()
        # Mitsuba moves the origins of rays by about 0.1 mm: rooms of all sizes are computed as such of 4 m, with the same illuminance.
        middle, scale = np.mean(np.concatenate([corners for _, corners in faces]), axis=0), 4.0 / size
        faces = [(material, scale * (corners - middle)) for material, corners in faces]
        places[:, :3] = scale * (places[:, :3] - middle)
        truth, is_open = places[:, 7:9].copy(), places[:, 6] == 0
        places = places[is_open]
        lux, error = irradiance(mitsuba_scene(materials, faces), places, scale * size, arguments.samples)
        truth[is_open, 0], truth[is_open, 1] = lux, error
        np.savetxt(path + ".truth", truth, fmt="%.9g", delimiter=",")
        both = np.maximum(np.hypot(error, places[:, 8]), 1e-12)
        print(f"{path}: {len(places)} places, mean ratio {places[:, 7].sum() / lux.sum():.4f} +- "
              f"{np.sqrt((both ** 2).sum()) / lux.sum():.4f}, RMS difference {np.sqrt((((lux - places[:, 7]) / both) ** 2).mean()):.2f} "
              "standard errors")


if __name__ == "__main__":
    main()
